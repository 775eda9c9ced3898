#pragma once

#include <string>

#include "telltale/idl/codec/messages/diagnosis.hpp"
#include "telltale/idl/codec/messages/model.hpp"
#include "telltale/idl/proto/model.pb.h"
#include "telltale/idl/proto/report.pb.h"

namespace telltale {

/// A published model: with its revision, time and verdict.
proto::Model ToProto(const PublishedModel& model);

/// A published diagnosis: with the revision it held against the window, and its time.
proto::Report ToProto(const PublishedDiagnosis& diagnosis);

/// model.json and report.json of them.
std::string PrintModelJson(const PublishedModel& model);
std::string PrintReportJson(const PublishedDiagnosis& diagnosis);

}  // namespace telltale
