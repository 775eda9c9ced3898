#pragma once

#include <string>

#include "telltale/service/jobs/request_journal.hpp"

namespace telltale {

/// A request to identify "boat".
inline AnyRequest RequestCalled(const std::string& correlation_id) {
  IdentifyRequest request;
  request.correlation_id = correlation_id;
  request.vehicle_id = "boat";
  return request;
}

}  // namespace telltale
