#pragma once

#include <string>

#include "telltale/idl/codec/messages/exchange.hpp"

namespace telltale {

/// A reply to this request with this outcome, and no result yet.
template <class Reply, class Request>
Reply ReplyTo(const Request& request, ReplyOutcome outcome, const std::string& message = {}) {
  Reply reply;
  reply.correlation_id = request.correlation_id;
  reply.vehicle_id = request.vehicle_id;
  reply.outcome = outcome;
  reply.message = message;
  return reply;
}

}  // namespace telltale
