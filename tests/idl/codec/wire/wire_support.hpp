#pragma once

#include <gtest/gtest.h>

#include "support/made_up_identifications.hpp"
#include "telltale/idl/codec/messages/model.hpp"

namespace telltale {

inline PublishedModel MadeUpModel() {
  return {MadeUpIdentification(), 7, 1700000700.5};
}

inline void ExpectSame(const PublishedModel& a, const PublishedModel& b) {
  EXPECT_EQ(a.revision, b.revision);
  EXPECT_EQ(a.published_unix_s, b.published_unix_s);
  ExpectSame(a.identification, b.identification);
}

/// Gives a string of a wire struct another text, or null.
inline void Replace(char*& text, const char* other) {
  dds_string_free(text);
  text = other == nullptr ? nullptr : dds_string_dup(other);
}

}  // namespace telltale
