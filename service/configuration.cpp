#include "telltale/service/configuration.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "telltale/client/recording/file_contents.hpp"
#include "telltale/idl/codec/mapping_file.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"
#include "telltale/service/sources/source_of_settings.hpp"

namespace telltale {
namespace {

Decoded<std::string> Read(const std::filesystem::path& file, std::string field) {
  auto text = ReadFile(file);
  if (text) return std::move(*text);
  return tl::unexpected(CodecError{std::move(field), file.string(),
                                   text.error().reason + "; " + text.error().advice});
}

/// Paths are beside the configuration unless they are absolute.
void ResolvePaths(const std::filesystem::path& folder, HttpSettings& http) {
  for (std::string* path : {&http.token_file, &http.tls_chain_file, &http.tls_key_file}) {
    if (!path->empty()) *path = folder / *path;
  }
}

/// Reads the mappings that sources name, and refuses what no source can be made of.
std::optional<CodecError> CompleteSources(const std::filesystem::path& file,
                                          std::vector<SourceSettings>& sources) {
  for (std::size_t i = 0; i < sources.size(); ++i) {
    SourceSettings& source = sources[i];
    const std::string field = "sources[" + std::to_string(i) + "]";
    if (source.ros2 && !source.ros2->mapping_file.empty()) {
      const auto mapping_file = file.parent_path() / source.ros2->mapping_file;
      const auto text = Read(mapping_file, field + ".ros2.mapping_file");
      if (!text) return text.error();
      auto mapping = ParseMapping(*text, mapping_file.string());
      if (!mapping) return mapping.error();
      source.ros2->mapping = std::make_shared<const Mapping>(*std::move(mapping));
    }
    if (auto fault = SourceFault(source)) {
      fault->field = field + "." + fault->field;
      fault->where = file.string();
      return fault;
    }
  }
  return std::nullopt;
}

/// In the order of their names.
Decoded<std::vector<std::filesystem::path>> VehicleFilesIn(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().extension() == ".textproto") files.push_back(entry->path());
  }
  if (error) {
    return tl::unexpected(CodecError{"vehicle_folder", folder.string(),
                                     "a folder that can be read; " + error.message()});
  }
  std::ranges::sort(files);
  return files;
}

}  // namespace

Decoded<DaemonConfig> LoadConfiguration(const std::filesystem::path& file) {
  const auto text = Read(file, "config");
  if (!text) return tl::unexpected(text.error());
  auto config = ParseDaemonConfig(*text, file.string());
  if (!config) return config;
  if (config->http) ResolvePaths(file.parent_path(), *config->http);
  if (auto fault = CompleteSources(file, config->sources)) return tl::unexpected(*std::move(fault));
  std::vector<std::filesystem::path> vehicle_files(config->vehicle_files.begin(),
                                                   config->vehicle_files.end());
  if (!config->vehicle_folder.empty()) {
    const auto found = VehicleFilesIn(file.parent_path() / config->vehicle_folder);
    if (!found) return tl::unexpected(found.error());
    vehicle_files.insert(vehicle_files.end(), found->begin(), found->end());
  }
  for (const std::filesystem::path& named : vehicle_files) {
    const auto vehicle_file = file.parent_path() / named;
    const auto vehicle_text = Read(vehicle_file, "vehicle_files");
    if (!vehicle_text) return tl::unexpected(vehicle_text.error());
    auto vehicle = ParseVehicle(*vehicle_text, vehicle_file.string());
    if (!vehicle) return tl::unexpected(vehicle.error());
    config->vehicles.push_back(std::move(*vehicle));
  }
  if (auto twice = DuplicateVehicle(config->vehicles)) return tl::unexpected(std::move(*twice));
  return config;
}

}  // namespace telltale
