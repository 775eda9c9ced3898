#include "telltale/client/bus/bus_log.hpp"

#include <mutex>
#include <string_view>

#include <dds/ddsrt/log.h>

namespace telltale {
namespace {

spdlog::level::level_enum LevelOf(std::uint32_t priority) {
  if (priority & (DDS_LC_FATAL | DDS_LC_ERROR)) return spdlog::level::err;
  if (priority & DDS_LC_WARNING) return spdlog::level::warn;
  if (priority & DDS_LC_INFO) return spdlog::level::info;
  return spdlog::level::trace;
}

std::string_view MessageOf(const dds_log_data_t& data) {
  std::string_view message(data.message, data.size);
  while (message.ends_with('\n')) message.remove_suffix(1);
  return message;
}

/// The topic of a sample that could not be read, from "... deserialization TOPIC/TYPE failed ...";
/// empty where the message is about something else.
std::string_view UnreadableTopicIn(std::string_view message) {
  constexpr std::string_view kBefore = "deserialization ";
  const auto found = message.find(kBefore);
  if (found == std::string_view::npos) return {};
  message.remove_prefix(found + kBefore.size());
  message = message.substr(0, message.find(' '));
  return message.substr(0, message.rfind('/'));
}

}  // namespace

std::optional<std::uint64_t> RateLimit::Admit(TimePoint now) {
  if (!period_start_ || now - *period_start_ >= period_) {
    period_start_ = now;
    admitted_ = 0;
  }
  if (admitted_ == limit_) {
    ++held_back_;
    return std::nullopt;
  }
  ++admitted_;
  return std::exchange(held_back_, 0);
}

struct BusLog::Sink {
  std::shared_ptr<spdlog::logger> logger;
  std::mutex mutex;
  RateLimit limit{20, std::chrono::seconds(10)};
  UnreadableHandler unreadable;

  static void Write(void* self, const dds_log_data_t* data) {
    static_cast<Sink*>(self)->Write(*data);
  }

  void Write(const dds_log_data_t& data) {
    const auto topic = UnreadableTopicIn(MessageOf(data));
    if (unreadable && !topic.empty()) unreadable(topic);
    const std::lock_guard lock(mutex);
    const auto held_back = limit.Admit(std::chrono::steady_clock::now());
    if (!held_back) return;
    if (*held_back > 0) logger->warn("dds: {} lines held back", *held_back);
    logger->log(LevelOf(data.priority), "dds: {}", MessageOf(data));
  }
};

BusLog::BusLog(std::shared_ptr<spdlog::logger> logger, UnreadableHandler unreadable)
    : sink_(std::make_unique<Sink>()) {
  sink_->logger = std::move(logger);
  sink_->unreadable = std::move(unreadable);
  dds_set_log_sink(&Sink::Write, sink_.get());
}

BusLog::~BusLog() {
  dds_set_log_sink(nullptr, nullptr);
}

}  // namespace telltale
