#include "telltale/service/jobs/reply_size.hpp"

#include "telltale/idl/codec/json/model.hpp"
#include "telltale/idl/codec/json/report.hpp"

namespace telltale {
namespace {

std::size_t SizeOfTexts(const ExchangeReply& reply) {
  std::size_t bytes = sizeof reply + reply.message.size();
  for (const Refusal& refusal : reply.refusals) {
    bytes +=
        sizeof refusal + refusal.subject.size() + refusal.reason.size() + refusal.advice.size();
  }
  return bytes;
}

std::size_t SizeOf(const Identification& identification) {
  return ToProto(identification).ByteSizeLong();
}

}  // namespace

std::size_t SizeOf(const IdentifyReply& reply) {
  return SizeOfTexts(reply) + (reply.model ? SizeOf(reply.model->identification) : 0);
}

std::size_t SizeOf(const DiagnoseReply& reply) {
  return SizeOfTexts(reply) + (reply.augmented ? SizeOf(*reply.augmented) : 0) +
         (reply.diagnosis ? ToProto(reply.diagnosis->diagnosis).ByteSizeLong() : 0);
}

}  // namespace telltale
