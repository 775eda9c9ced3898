#include "telltale/service/monitoring/fleet_watcher.hpp"

#include <chrono>
#include <exception>

#include <spdlog/spdlog.h>

#include "telltale/idl/codec/wire/diagnosis.hpp"
#include "telltale/idl/codec/wire/exchange.hpp"

namespace telltale {
namespace {

// A reader is never made anew: the daemon's own answers are rare, and silence is no fault.
constexpr std::chrono::hours kAnySilence{1'000'000};

}  // namespace

FleetWatcher::FleetWatcher(const Participant& participant, FleetView& view)
    : wait_set_(participant),
      diagnoses_(
          participant, wait_set_,
          [&view](const auto& wire) {
            if (const auto diagnosis = Decode(wire)) view.Take(*diagnosis);
          },
          kAnySilence),
      identify_progress_(
          participant, wait_set_,
          [&view](const auto& wire) {
            if (const auto progress = Decode(wire)) view.Take(*progress);
          },
          kAnySilence),
      identify_replies_(
          participant, wait_set_,
          [&view](const auto& wire) {
            if (const auto reply = Decode(wire)) view.Take(*reply);
          },
          kAnySilence),
      diagnose_progress_(
          participant, wait_set_,
          [&view](const auto& wire) {
            if (const auto progress = Decode(wire)) view.Take(*progress);
          },
          kAnySilence),
      diagnose_replies_(
          participant, wait_set_,
          [&view](const auto& wire) {
            if (const auto reply = Decode(wire)) view.Take(*reply);
          },
          kAnySilence),
      thread_([this] { Run(); }) {}

FleetWatcher::~FleetWatcher() {
  stopping_ = true;
  wait_set_.Wake();
  thread_.join();
}

void FleetWatcher::Run() {
  while (!stopping_) {
    try {
      wait_set_.Wait(std::chrono::seconds(1));
    } catch (const std::exception& error) {
      spdlog::error("monitoring: {}", error.what());
    }
  }
}

}  // namespace telltale
