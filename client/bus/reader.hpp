#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include "telltale/client/bus/bus_error.hpp"
#include "telltale/client/bus/endpoint.hpp"
#include "telltale/client/bus/instance_limit.hpp"
#include "telltale/client/bus/topics.hpp"

namespace telltale {

/// Receives samples of one wire type under its topic's contract. Use from one thread at a time, and
/// never inside a DDS listener.
template <class Wire>
class Reader : public Endpoint {
 public:
  /// `qos`: the contract of the topic, or one that is made from it.
  explicit Reader(const Participant& participant, const Qos& qos = kContract<Wire>.qos())
      : Endpoint(participant, Kind::kReader, Descriptor<Wire>(), kContract<Wire>.topic, qos.get()) {
    Checked(dds_set_status_mask(handle(), DDS_DATA_AVAILABLE_STATUS), "setting a status mask");
  }

  /// The same, of so many keys. The limit outlives the reader.
  Reader(const Participant& participant, InstanceLimit& limit)
      : Endpoint(participant, Kind::kReader, LimitedTopic(participant, limit),
                 kContract<Wire>.topic, kContract<Wire>.qos().get()) {
    Checked(dds_set_status_mask(handle(), DDS_DATA_AVAILABLE_STATUS), "setting a status mask");
  }

  /// How many of the writers that it is connected to assert their liveliness.
  std::uint32_t AliveWriters() const {
    dds_liveliness_changed_status_t status;
    Checked(dds_get_liveliness_changed_status(handle(), &status), "asking which writers are alive");
    return status.alive_count;
  }

  /// Hands all samples that have arrived to `receive(const Wire&)`, or to `receive(const Wire&,
  /// WriterHandle writer)` or `receive(const Wire&, WriterHandle, InstanceHandle)`, and forgets
  /// them; returns how many there were. Notices without
  /// data (a writer gone, an instance disposed) are passed over. A sample is only lent: what
  /// `receive` wants to keep it copies.
  template <class Receive>
  std::size_t Take(Receive receive) {
    return Take(receive, [](const Wire&) {});
  }

  /// The same, and `gone(const Wire&)` is told of each instance that no writer that is alive
  /// writes any more; of that sample only the key can be read.
  template <class Receive, class Gone>
  std::size_t Take(Receive receive, Gone gone) {
    std::size_t received = 0;
    TakeAll([&](const Loan& loan, std::size_t i) {
      if (!loan.valid(i)) return gone(loan[i]);
      Hand(receive, loan, i);
      ++received;
    });
    return received;
  }

  /// The same, and `disposed(const Wire&, WriterHandle)` is told of each instance that a writer
  /// disposes of, whatever else has arrived of it before; of that sample only the key counts. A
  /// writer that leaves without a word disposes of nothing.
  template <class Receive, class Disposed>
  std::size_t TakeOrDispose(Receive receive, Disposed disposed) {
    std::size_t received = 0;
    TakeAll([&](const Loan& loan, std::size_t i) {
      if (loan.disposed(i)) return disposed(loan[i], loan.writer(i));
      if (!loan.valid(i)) return;
      Hand(receive, loan, i);
      ++received;
    });
    return received;
  }

 private:
  static Entity LimitedTopic(const Participant& participant, InstanceLimit& limit) {
    Entity topic = MakeTopic(participant, Descriptor<Wire>(), kContract<Wire>.topic);
    limit.ApplyTo(topic);
    return topic;
  }

  static constexpr std::size_t kBatch = 256;  // one at a time falls behind a fast writer

  /// A batch of samples borrowed from the reader, given back however this ends.
  class Loan {
   public:
    explicit Loan(dds_entity_t reader)
        : reader_(reader),
          size_(static_cast<std::size_t>(
              Checked(dds_take(reader, samples_.data(), infos_.data(), kBatch, kBatch),
                      "taking samples"))) {}
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    ~Loan() {
      if (size_ > 0) dds_return_loan(reader_, samples_.data(), static_cast<std::int32_t>(size_));
    }

    std::size_t size() const { return size_; }
    bool valid(std::size_t i) const { return infos_[i].valid_data; }
    bool disposed(std::size_t i) const {
      return infos_[i].instance_state == DDS_IST_NOT_ALIVE_DISPOSED;
    }
    WriterHandle writer(std::size_t i) const { return infos_[i].publication_handle; }
    InstanceHandle instance(std::size_t i) const { return infos_[i].instance_handle; }
    const Wire& operator[](std::size_t i) const { return *static_cast<const Wire*>(samples_[i]); }

   private:
    dds_entity_t reader_;
    std::array<void*, kBatch> samples_{};
    std::array<dds_sample_info_t, kBatch> infos_{};
    std::size_t size_;
  };

  template <class One>
  void TakeAll(One one) {
    for (;;) {
      const Loan loan(handle());
      for (std::size_t i = 0; i < loan.size(); ++i) one(loan, i);
      if (loan.size() < kBatch) return;
    }
  }

  template <class Receive>
  static void Hand(Receive& receive, const Loan& loan, std::size_t i) {
    if constexpr (std::is_invocable_v<Receive&, const Wire&, WriterHandle, InstanceHandle>) {
      receive(loan[i], loan.writer(i), loan.instance(i));
    } else if constexpr (std::is_invocable_v<Receive&, const Wire&, WriterHandle>) {
      receive(loan[i], loan.writer(i));
    } else {
      receive(loan[i]);
    }
  }
};

}  // namespace telltale
