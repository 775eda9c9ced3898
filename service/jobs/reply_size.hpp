#pragma once

#include <cstddef>

#include "telltale/idl/codec/messages/exchange.hpp"

namespace telltale {

/// About how many bytes a reply takes: those of its model or diagnosis as they are stored, which
/// are most of it, and its texts.
std::size_t SizeOf(const IdentifyReply& reply);
std::size_t SizeOf(const DiagnoseReply& reply);

}  // namespace telltale
