#include "telltale/client/bridge/mavlink_link.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <map>
#include <stdexcept>
#include <utility>

#include <boost/asio.hpp>

namespace telltale {
namespace {

namespace asio = boost::asio;
using Udp = asio::ip::udp;
using Tcp = asio::ip::tcp;
using Error = boost::system::error_code;

constexpr std::size_t kLargestDatagram = 65536;
constexpr auto kSecond = std::chrono::seconds(1);
/// More senders than these are no fleet on one port: the book of senders begins anew.
constexpr std::size_t kMostSenders = 1024;

std::string TextOf(const MavlinkAddress& address) {
  const bool serial = address.kind == MavlinkAddress::Kind::kSerial;
  const std::string scheme = serial                                       ? "serial:"
                             : address.kind == MavlinkAddress::Kind::kTcp ? "tcp:"
                                                                          : "udp:";
  return scheme + address.place + ':' + std::to_string(address.number);
}

template <class Protocol>
typename Protocol::endpoint Resolved(asio::io_context& context, const MavlinkAddress& address) {
  typename Protocol::resolver resolver(context);
  Error error;
  const auto found = resolver.resolve(address.place, std::to_string(address.number), error);
  if (error || found.empty()) {
    throw std::runtime_error(TextOf(address) + ": no host of this name: " + error.message());
  }
  return *found.begin();
}

}  // namespace

/// The loop that all kinds share.
class MavlinkLink::Transport {
 public:
  explicit Transport(const MavlinkAddress& address) : name_(TextOf(address)) {}
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  void Run(const MavlinkLinkEvents& events) {
    events_ = &events;
    Begin();
    NextSecond();
    context_.run();
  }

  void Stop() { context_.stop(); }
  const std::optional<std::string>& Fault() const { return fault_; }

  virtual void Send(const std::string& sender, std::span<const std::uint8_t> bytes) = 0;

 protected:
  virtual void Begin() = 0;
  virtual void EachSecond() {}

  asio::io_context& context() { return context_; }
  const MavlinkLinkEvents& events() const { return *events_; }
  const std::string& name() const { return name_; }

  void ReportFault(const std::string& fault) {
    if (!fault_) events_->report(fault + "; trying again every second");
    fault_ = fault;
  }
  void ReportMended(const std::string& how) {
    fault_.reset();
    events_->report(name_ + how);
  }

 private:
  void NextSecond() {
    timer_.expires_after(kSecond);
    timer_.async_wait([this](Error error) {
      if (error) return;
      EachSecond();
      events_->second();
      NextSecond();
    });
  }

  std::string name_;
  asio::io_context context_;
  asio::steady_timer timer_{context_};
  const MavlinkLinkEvents* events_ = nullptr;
  std::optional<std::string> fault_;
};

class MavlinkLink::Datagrams : public Transport {
 public:
  explicit Datagrams(const MavlinkAddress& address) : Transport(address), socket_(context()) {
    const Udp::endpoint endpoint = Resolved<Udp>(context(), address);
    Error error;
    socket_.open(endpoint.protocol(), error);
    if (!error) socket_.bind(endpoint, error);
    if (!error) socket_.non_blocking(true, error);
    if (error) throw std::runtime_error(name() + " cannot be listened on: " + error.message());
  }

  void Send(const std::string& sender, std::span<const std::uint8_t> bytes) override {
    const auto found = senders_.find(sender);
    Error lost;
    if (found != senders_.end()) {
      socket_.send_to(asio::buffer(bytes.data(), bytes.size()), found->second, 0, lost);
    }
  }

 protected:
  void Begin() override {
    socket_.async_receive_from(asio::buffer(buffer_), from_, [this](Error error, std::size_t size) {
      if (error == asio::error::operation_aborted) return;
      // Another error tells that something sent earlier found nobody: nothing to do about it.
      if (!error) Deliver(size);
      Begin();
    });
  }

 private:
  void Deliver(std::size_t size) {
    const std::string sender = from_.address().to_string() + ':' + std::to_string(from_.port());
    if (senders_.size() == kMostSenders && !senders_.contains(sender)) senders_.clear();
    senders_[sender] = from_;
    events().received(sender, std::span(buffer_).first(size), true);
  }

  Udp::socket socket_;
  Udp::endpoint from_;
  std::map<std::string, Udp::endpoint> senders_;
  std::array<std::uint8_t, kLargestDatagram> buffer_{};
};

class MavlinkLink::Connection : public Transport {
 public:
  explicit Connection(const MavlinkAddress& address)
      : Transport(address), endpoint_(Resolved<Tcp>(context(), address)), socket_(context()) {}

  void Send(const std::string&, std::span<const std::uint8_t> bytes) override {
    Error lost;
    if (connected_) socket_.send(asio::buffer(bytes.data(), bytes.size()), 0, lost);
  }

 protected:
  void Begin() override {
    connecting_ = true;
    socket_ = Tcp::socket(context());
    socket_.async_connect(endpoint_, [this](Error error) {
      connecting_ = false;
      if (error) return Lose("cannot be reached", error);
      connected_ = true;
      Error ignored;
      socket_.non_blocking(true, ignored);
      ReportMended(" is connected");
      Receive();
    });
  }

  void EachSecond() override {
    if (!connected_ && !connecting_) Begin();
  }

 private:
  void Receive() {
    socket_.async_read_some(asio::buffer(buffer_), [this](Error error, std::size_t size) {
      if (error) return Lose("is lost", error);
      events().received(name(), std::span(buffer_).first(size), false);
      Receive();
    });
  }

  void Lose(const std::string& how, const Error& error) {
    connected_ = false;
    if (error == asio::error::operation_aborted) return;
    ReportFault(name() + ' ' + how + ": " + error.message());
  }

  Tcp::endpoint endpoint_;
  Tcp::socket socket_;
  bool connecting_ = false;
  bool connected_ = false;
  std::array<std::uint8_t, kLargestDatagram> buffer_{};
};

class MavlinkLink::SerialLine : public Transport {
 public:
  explicit SerialLine(const MavlinkAddress& address)
      : Transport(address), address_(address), port_(context()) {
    const Error error = Open();
    if (error) throw std::runtime_error(name() + " cannot be opened: " + WhyNot(error));
  }

  void Send(const std::string&, std::span<const std::uint8_t> bytes) override {
    Error lost;
    if (port_.is_open()) port_.write_some(asio::buffer(bytes.data(), bytes.size()), lost);
  }

 protected:
  void Begin() override {
    port_.async_read_some(asio::buffer(buffer_), [this](Error error, std::size_t size) {
      if (error == asio::error::operation_aborted) return;
      if (error) {
        ReportFault(name() + " is lost: " + error.message());
        port_.close(error);
        return;
      }
      events().received(name(), std::span(buffer_).first(size), false);
      Begin();
    });
  }

  void EachSecond() override {
    if (port_.is_open() || Open()) return;
    ReportMended(" is open again");
    Begin();
  }

 private:
  Error Open() {
    Error error;
    port_.open(address_.place, error);
    if (!error) port_.set_option(asio::serial_port::baud_rate(address_.number), error);
    if (!error) port_.set_option(asio::serial_port::character_size(8), error);
    if (error && port_.is_open()) {
      Error ignored;
      port_.close(ignored);
    }
    return error;
  }

  std::string WhyNot(const Error& error) const {
    if (error.value() == ENOTTY || error.value() == EISDIR) return "it is no serial device";
    if (error.value() != EINVAL) return error.message();
    return "it has no rate of " + std::to_string(address_.number) +
           " baud; 57600 and 115200 are usual";
  }

  MavlinkAddress address_;
  asio::serial_port port_;
  std::array<std::uint8_t, kLargestDatagram> buffer_{};
};

MavlinkLink::MavlinkLink(const MavlinkAddress& address) {
  switch (address.kind) {
    case MavlinkAddress::Kind::kUdp: transport_ = std::make_unique<Datagrams>(address); return;
    case MavlinkAddress::Kind::kTcp: transport_ = std::make_unique<Connection>(address); return;
    case MavlinkAddress::Kind::kSerial: transport_ = std::make_unique<SerialLine>(address); return;
    case MavlinkAddress::Kind::kUnknown: break;
  }
  throw std::runtime_error("no MAVLink address is given");
}

MavlinkLink::~MavlinkLink() = default;

void MavlinkLink::Run(const MavlinkLinkEvents& events) {
  transport_->Run(events);
}

void MavlinkLink::Stop() {
  transport_->Stop();
}

std::optional<std::string> MavlinkLink::Fault() const {
  return transport_->Fault();
}

void MavlinkLink::Send(const std::string& sender, std::span<const std::uint8_t> bytes) {
  transport_->Send(sender, bytes);
}

}  // namespace telltale
