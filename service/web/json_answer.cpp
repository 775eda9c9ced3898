#include "telltale/service/web/json_answer.hpp"

#include <charconv>
#include <functional>
#include <system_error>

#include <fmt/format.h>

#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/proto/fleet.pb.h"

namespace telltale {

void AnswerJson(const google::protobuf::Message& message, const httplib::Request& request,
                httplib::Response& response) {
  const std::string body = PrintJsonLine(message);
  response.set_header("Cache-Control", "no-cache");
  if (request.method == "GET") {
    const std::string tag = EntityTag(body);
    response.set_header("ETag", tag);
    if (HasEntity(request, tag)) {
      response.status = 304;
      return;
    }
  }
  response.set_content(body, "application/json");
}

void AnswerFailure(int status, const std::string& error, const std::string& allowed,
                   httplib::Response& response) {
  proto::Failure failure;
  failure.set_error(error);
  failure.set_allowed(allowed);
  response.status = status;
  response.set_content(PrintJsonLine(failure), "application/json");
}

std::string EntityTag(std::string_view body) {
  return fmt::format("\"{:016x}-{:x}\"", std::hash<std::string_view>()(body), body.size());
}

bool HasEntity(const httplib::Request& request, const std::string& tag) {
  const std::string known = request.get_header_value("If-None-Match");
  return known == "*" || known.find(tag) != std::string::npos;
}

std::optional<std::uint64_t> QueryCount(const httplib::Request& request, const char* name,
                                        std::uint64_t low, std::uint64_t high,
                                        std::uint64_t fallback, httplib::Response& response) {
  if (!request.has_param(name)) return fallback;
  const std::string text = request.get_param_value(name);
  std::uint64_t value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault == std::errc() && end == text.data() + text.size() && value >= low && value <= high) {
    return value;
  }
  AnswerFailure(400, fmt::format("{} is '{}'", name, text.substr(0, 64)),
                fmt::format("a whole number in [{}, {}]", low, high), response);
  return std::nullopt;
}

}  // namespace telltale
