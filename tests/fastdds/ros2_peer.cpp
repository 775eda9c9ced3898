// Another DDS, Fast DDS, in the place of nodes of ROS 2, on loopback:
//
//   ros2_peer DOMAIN publish BOAT...       sensors of boats, until SIGTERM
//   ros2_peer DOMAIN ardupilot             the topics of an ArduPilot (AP_DDS), until SIGTERM
//   ros2_peer DOMAIN subscribe TOPIC...    topics of String, and /diagnostics, until SIGTERM
//
// Sample i = 0, 1, ... of each boat goes out every 50 ms, stamped BEGIN + 0.05 i, where BEGIN is
// the first line of output, in nanoseconds since 1970:
//   /BOAT/mavros/global_position/raw/fix  NavSatFix, best effort: latitude 63 + 1e-6 i, longitude
//   10 - 1e-6 i;
//                                         each tenth without a fix
//   /BOAT/mavros/imu/data                 Imu, reliable: yaw 0.01 i from east, anticlockwise
//   /BOAT/mavros/rc/out                   RCOut, reliable: channels 1100 + i % 800, 0, 1900 - i %
//   800
// An ArduPilot has no outputs; both of its topics are best effort, in the same places and headings:
//   /ap/navsat            NavSatFix
//   /ap/geopose/filtered  GeoPoseStamped
// A subscriber prints what comes: "string TOPIC TEXT", "diagnostics LEVEL NAME: MESSAGE", texts in
// one line.
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

#include "ros2_messagesPubSubTypes.h"

namespace {

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using Clock = std::chrono::system_clock;

constexpr auto kPeriod = std::chrono::milliseconds(50);
std::atomic<bool> stopped = false;

fast::DomainParticipant* JoinOnLoopback(std::uint32_t domain) {
  fast::DomainParticipantQos qos = fast::PARTICIPANT_QOS_DEFAULT;
  const auto loopback = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  loopback->interfaceWhiteList = {"127.0.0.1"};
  loopback->maxInitialPeersRange = 10;
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports = {loopback};
  auto& builtin = qos.wire_protocol().builtin;
  builtin.avoid_builtin_multicast = true;
  builtin.discovery_config.leaseDuration_announcementperiod = {1, 0};
  rtps::Locator_t here;
  rtps::IPLocator::setIPv4(here, "127.0.0.1");
  builtin.metatrafficUnicastLocatorList.push_back(here);
  builtin.initialPeersList.push_back(here);
  return fast::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
}

template <class PubSubType>
fast::Topic* TopicOf(fast::DomainParticipant& participant, const std::string& name) {
  const fast::TypeSupport type(new PubSubType);
  type.register_type(&participant);
  return participant.create_topic("rt" + name, type.get_type_name(), fast::TOPIC_QOS_DEFAULT);
}

template <class PubSubType>
class Output {
 public:
  Output(fast::DomainParticipant& participant, fast::Publisher& publisher, const std::string& topic,
         fast::ReliabilityQosPolicyKind reliability) {
    fast::DataWriterQos qos = fast::DATAWRITER_QOS_DEFAULT;
    qos.reliability().kind = reliability;
    writer_ = publisher.create_datawriter(TopicOf<PubSubType>(participant, topic), qos);
  }
  void Write(typename PubSubType::type& message) { writer_->write(&message); }

 private:
  fast::DataWriter* writer_;
};

/// Sample i, stamped `ns`.
std_msgs::msg::Header HeaderAt(std::int64_t ns) {
  std_msgs::msg::Header header;
  header.stamp().sec(static_cast<std::int32_t>(ns / 1000000000));
  header.stamp().nanosec(static_cast<std::uint32_t>(ns % 1000000000));
  header.frame_id("base_link");
  return header;
}

sensor_msgs::msg::NavSatFix FixAt(int i, std::int64_t ns) {
  sensor_msgs::msg::NavSatFix fix;
  fix.header(HeaderAt(ns));
  fix.status().status(i % 10 == 9 ? -1 : 0);
  fix.latitude(63.0 + 1e-6 * i);
  fix.longitude(10.0 - 1e-6 * i);
  return fix;
}

geometry_msgs::msg::Quaternion OrientationAt(int i) {
  geometry_msgs::msg::Quaternion orientation;
  orientation.z(std::sin(0.005 * i));
  orientation.w(std::cos(0.005 * i));
  return orientation;
}

class ArduPilot {
 public:
  ArduPilot(fast::DomainParticipant& participant, fast::Publisher& publisher)
      : fix_(participant, publisher, "/ap/navsat", fast::BEST_EFFORT_RELIABILITY_QOS),
        pose_(participant, publisher, "/ap/geopose/filtered", fast::BEST_EFFORT_RELIABILITY_QOS) {}

  void Publish(int i, std::int64_t ns) {
    sensor_msgs::msg::NavSatFix fix = FixAt(i, ns);
    fix_.Write(fix);
    geographic_msgs::msg::GeoPoseStamped pose;
    pose.header(HeaderAt(ns));
    pose.pose().position().latitude(fix.latitude());
    pose.pose().position().longitude(fix.longitude());
    pose.pose().orientation(OrientationAt(i));
    pose_.Write(pose);
  }

 private:
  Output<sensor_msgs::msg::NavSatFixPubSubType> fix_;
  Output<geographic_msgs::msg::GeoPoseStampedPubSubType> pose_;
};

class Boat {
 public:
  Boat(fast::DomainParticipant& participant, fast::Publisher& publisher, const std::string& name)
      : fix_(participant, publisher, "/" + name + "/mavros/global_position/raw/fix",
             fast::BEST_EFFORT_RELIABILITY_QOS),
        imu_(participant, publisher, "/" + name + "/mavros/imu/data",
             fast::RELIABLE_RELIABILITY_QOS),
        outputs_(participant, publisher, "/" + name + "/mavros/rc/out",
                 fast::RELIABLE_RELIABILITY_QOS) {}

  void Publish(int i, std::int64_t ns) {
    sensor_msgs::msg::NavSatFix fix = FixAt(i, ns);
    fix_.Write(fix);

    sensor_msgs::msg::Imu imu;
    imu.header(HeaderAt(ns));
    imu.orientation(OrientationAt(i));
    imu_.Write(imu);

    mavros_msgs::msg::RCOut outputs;
    outputs.header(HeaderAt(ns));
    outputs.channels({static_cast<std::uint16_t>(1100 + i % 800), 0,
                      static_cast<std::uint16_t>(1900 - i % 800)});
    outputs_.Write(outputs);
  }

 private:
  Output<sensor_msgs::msg::NavSatFixPubSubType> fix_;
  Output<sensor_msgs::msg::ImuPubSubType> imu_;
  Output<mavros_msgs::msg::RCOutPubSubType> outputs_;
};

/// Calls publish(i, ns) every period.
template <class PublishSample>
void PublishUntilStopped(PublishSample publish) {
  const auto begin = Clock::now();
  const auto since = std::chrono::duration_cast<std::chrono::nanoseconds>(begin.time_since_epoch());
  std::cout << since.count() << std::endl;
  for (int i = 0; !stopped; ++i) {
    std::this_thread::sleep_until(begin + i * kPeriod);
    publish(i, (since + std::chrono::nanoseconds(kPeriod) * i).count());
  }
}

void PublishBoats(fast::DomainParticipant& participant, const std::vector<std::string>& names) {
  fast::Publisher& publisher = *participant.create_publisher(fast::PUBLISHER_QOS_DEFAULT);
  std::vector<std::unique_ptr<Boat>> boats;
  for (const std::string& name : names) {
    boats.push_back(std::make_unique<Boat>(participant, publisher, name));
  }
  PublishUntilStopped([&](int i, std::int64_t ns) {
    for (const auto& boat : boats) boat->Publish(i, ns);
  });
}

void PublishArduPilot(fast::DomainParticipant& participant) {
  ArduPilot autopilot(participant, *participant.create_publisher(fast::PUBLISHER_QOS_DEFAULT));
  PublishUntilStopped([&](int i, std::int64_t ns) { autopilot.Publish(i, ns); });
}

void Print(const std::string& topic, const std_msgs::msg::String& message) {
  std::string line = message.data();
  std::erase(line, '\n');
  std::cout << "string " << topic << ' ' << line << std::endl;
}

void Print(const std::string&, const diagnostic_msgs::msg::DiagnosticArray& message) {
  for (const auto& status : message.status()) {
    std::cout << "diagnostics " << static_cast<int>(status.level()) << ' ' << status.name() << ": "
              << status.message() << std::endl;
  }
}

template <class PubSubType>
class Input : public fast::DataReaderListener {
 public:
  Input(fast::DomainParticipant& participant, fast::Subscriber& subscriber, std::string topic,
        fast::DurabilityQosPolicyKind durability)
      : topic_(std::move(topic)) {
    fast::DataReaderQos qos = fast::DATAREADER_QOS_DEFAULT;
    qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
    qos.durability().kind = durability;
    subscriber.create_datareader(TopicOf<PubSubType>(participant, topic_), qos, this);
  }

  void on_data_available(fast::DataReader* reader) override {
    static std::mutex output;
    typename PubSubType::type message;
    fast::SampleInfo info;
    while (reader->take_next_sample(&message, &info) ==
           eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
      const std::lock_guard lock(output);
      if (info.valid_data) Print(topic_, message);
    }
  }

 private:
  std::string topic_;
};

void Subscribe(fast::DomainParticipant& participant, const std::vector<std::string>& topics) {
  fast::Subscriber& subscriber = *participant.create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
  const Input<diagnostic_msgs::msg::DiagnosticArrayPubSubType> diagnostics(
      participant, subscriber, "/diagnostics", fast::VOLATILE_DURABILITY_QOS);
  std::vector<std::unique_ptr<Input<std_msgs::msg::StringPubSubType>>> strings;
  for (const std::string& topic : topics) {
    strings.push_back(std::make_unique<Input<std_msgs::msg::StringPubSubType>>(
        participant, subscriber, topic, fast::TRANSIENT_LOCAL_DURABILITY_QOS));
  }
  std::cout << "subscribed" << std::endl;
  while (!stopped) pause();
  participant.delete_contained_entities();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: ros2_peer DOMAIN publish BOAT... | ardupilot | subscribe TOPIC...\n";
    return 2;
  }
  std::signal(SIGTERM, [](int) { stopped = true; });
  fast::DomainParticipant* const participant =
      JoinOnLoopback(static_cast<std::uint32_t>(std::stoul(argv[1])));
  if (participant == nullptr) return 1;
  const std::vector<std::string> names(argv + 3, argv + argc);
  const std::string does = argv[2];
  if (does == "publish") {
    PublishBoats(*participant, names);
  } else if (does == "ardupilot") {
    PublishArduPilot(*participant);
  } else {
    Subscribe(*participant, names);
  }
  return 0;
}
