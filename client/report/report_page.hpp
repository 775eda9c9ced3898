#pragma once

#include <optional>
#include <string>
#include <vector>

#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/idl/codec/messages/diagnosis.hpp"

namespace telltale {

/// Where a diagnosis comes from, in words for people. The page leaves out what is empty.
struct ReportSources {
  std::vector<std::string> recordings;  ///< what was held against the model
  std::vector<std::string> references;  ///< recordings of the nominal boat
  std::string model;                    ///< its file, or its revision
  std::optional<double> published_unix_s;
};

/// Of a diagnosis that a daemon made: its window against the revision that it had published.
ReportSources SourcesOf(const PublishedDiagnosis& diagnosis);

/// A diagnosis as one HTML page that needs nothing else: styles and pictures are inside, there is
/// no script, and it reads on a phone as on a desk, in light and in dark. Requires: a gap at one
/// horizon or more.
std::string ReportPage(const Diagnosis& diagnosis, const ReportSources& sources = {});

}  // namespace telltale
