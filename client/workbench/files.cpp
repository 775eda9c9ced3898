#include "telltale/client/workbench/files.hpp"

#include <memory>
#include <string>
#include <utility>

#include "telltale/client/recording/file_contents.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/idl/codec/json/model.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

std::string TextOf(const std::filesystem::path& file) {
  auto text = ReadFile(file);
  if (!text) throw FileError(text.error().subject + ' ' + text.error().reason);
  return *std::move(text);
}

}  // namespace

Vehicle LoadVehicle(const std::filesystem::path& file) {
  return OrThrow(ParseVehicle(TextOf(file), file.string()));
}

std::shared_ptr<const Mapping> LoadMapping(const std::filesystem::path& file) {
  return std::make_shared<Mapping>(OrThrow(ParseMapping(TextOf(file), file.string())));
}

Identification LoadModel(const std::filesystem::path& file) {
  return OrThrow(ParseModelJson(TextOf(file), file.string()));
}

}  // namespace telltale
