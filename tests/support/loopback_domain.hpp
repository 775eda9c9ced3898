#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>

#include <gtest/gtest.h>

namespace telltale {

/// A DDS domain of the running test's own, for this process and those it starts: loopback only, and
/// a discovery tag that keeps tests that happen to use the same domain apart. A busy machine loses
/// an announcement now and then, and it is made again soon.
class LoopbackDomain {
 public:
  /// `is_tagged` false: for a DDS of another vendor, which knows no tags; the domain is then one
  /// that no other test is likely to use.
  explicit LoopbackDomain(bool is_tagged = true) {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    const std::string name = std::string(test->test_suite_name()) + "." + test->name();
    const std::string own = name + "." + std::to_string(getpid());
    id_ = static_cast<std::uint32_t>(std::hash<std::string>()(is_tagged ? name : own) % 101) + 1;
    const std::string tag = is_tagged ? "<Tag>" + own + "</Tag>" : std::string();
    const std::string configuration =
        "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\"/></Interfaces>"
        "<AllowMulticast>false</AllowMulticast></General><Discovery>" +
        tag +
        "<ParticipantIndex>auto</ParticipantIndex>"
        "<MaxAutoParticipantIndex>30</MaxAutoParticipantIndex>"
        "<SPDPInterval>1 s</SPDPInterval>"
        "<Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery></Domain></CycloneDDS>";
    setenv("CYCLONEDDS_URI", configuration.c_str(), 1);
  }

  std::uint32_t id() const { return id_; }

 private:
  std::uint32_t id_;
};

}  // namespace telltale
