#pragma once

#include <cstddef>
#include <vector>

#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/proto/report.pb.h"

namespace telltale {

/// The number of windows whose paths a report holds.
inline constexpr std::size_t kShownPaths = 6;

/// The windows with paths and the largest errors before the correction, at most kShownPaths, in the
/// order of time.
std::vector<std::size_t> WorstWindows(const std::vector<WindowPicture>& pictures);

/// Adds the pictures to a report, with the paths of the worst windows alone.
void WritePictures(const std::vector<WindowPicture>& pictures, proto::Report& report);

/// The way back of one; `reader` reads that very message. Faults: no single region, negative
/// errors, paths that are not pairs of numbers, errors that are not three numbers.
WindowPicture ReadPicture(FieldReader reader, const proto::WindowPicture& message);

}  // namespace telltale
