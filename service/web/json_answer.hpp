#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <google/protobuf/message.h>

#include "telltale/service/web/httplib.hpp"

namespace telltale {

/// Answers with the message. A GET carries an ETag, and one whose If-None-Match names it is
/// answered with 304.
void AnswerJson(const google::protobuf::Message& message, const httplib::Request& request,
                httplib::Response& response);

/// Answers with a proto::Failure. `allowed` says what would do; empty: nothing would.
void AnswerFailure(int status, const std::string& error, const std::string& allowed,
                   httplib::Response& response);

/// The ETag of a body.
std::string EntityTag(std::string_view body);

/// Whether If-None-Match of the request names the tag.
bool HasEntity(const httplib::Request& request, const std::string& tag);

/// A whole number of the query in [low, high], or `fallback` where it is not given; nothing after
/// it has answered 400.
std::optional<std::uint64_t> QueryCount(const httplib::Request& request, const char* name,
                                        std::uint64_t low, std::uint64_t high,
                                        std::uint64_t fallback, httplib::Response& response);

}  // namespace telltale
