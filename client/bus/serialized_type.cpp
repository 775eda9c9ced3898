#include "telltale/client/bus/serialized_type.hpp"

#include <cstring>
#include <exception>
#include <memory>
#include <span>

#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>

#include "telltale/client/bus/bus_error.hpp"

namespace telltale {
namespace {

// Cyclone DDS asks a type these questions, in C. Those about samples in memory have no answer here:
// nothing but serialised samples is ever read or written.

SerializedSample& Of(ddsi_serdata* sample) {
  return *static_cast<SerializedSample*>(sample);
}

const SerializedSample& Of(const ddsi_serdata* sample) {
  return *static_cast<const SerializedSample*>(sample);
}

/// Null where there is no memory for it, which the library takes for a sample that cannot be read.
template <class Fill>
ddsi_serdata* Made(const ddsi_sertype* type, ddsi_serdata_kind kind, Fill fill) {
  try {
    auto sample = std::make_unique<SerializedSample>();
    ddsi_serdata_init(sample.get(), type, kind);
    sample->hash = type->serdata_basehash;  // without a key all are one instance
    fill(sample->bytes);
    return sample.release();
  } catch (const std::exception&) {
    return nullptr;
  }
}

ddsi_serdata* FromFragments(const ddsi_sertype* type, ddsi_serdata_kind kind,
                            const nn_rdata* fragment, std::size_t size) {
  return Made(type, kind, [&](std::vector<std::uint8_t>& bytes) {
    bytes.reserve(size);
    for (; fragment != nullptr; fragment = fragment->nextfrag) {
      const std::size_t done = bytes.size();
      if (fragment->maxp1 <= done) continue;  // it overlaps with what is there
      const unsigned char* payload =
          NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
      bytes.insert(bytes.end(), payload + (done - fragment->min),
                   payload + (fragment->maxp1 - fragment->min));
    }
  });
}

ddsi_serdata* FromPieces(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                         const ddsrt_iovec_t* pieces, std::size_t size) {
  return Made(type, kind, [&](std::vector<std::uint8_t>& bytes) {
    bytes.reserve(size);
    for (const ddsrt_iovec_t& piece : std::span(pieces, count)) {
      const auto* begin = static_cast<const std::uint8_t*>(piece.iov_base);
      bytes.insert(bytes.end(), begin, begin + piece.iov_len);
    }
  });
}

ddsi_serdata* WithoutBytes(const ddsi_sertype* type) {
  return Made(type, SDK_KEY, [](std::vector<std::uint8_t>&) {});
}

constexpr ddsi_serdata_ops MakeSampleOps() {
  ddsi_serdata_ops ops{};
  ops.eqkey = [](const ddsi_serdata*, const ddsi_serdata*) { return true; };
  ops.get_size = [](const ddsi_serdata* sample) {
    return static_cast<std::uint32_t>(Of(sample).bytes.size());
  };
  ops.from_ser = FromFragments;
  ops.from_ser_iov = FromPieces;
  ops.from_keyhash = [](const ddsi_sertype* type, const ddsi_keyhash*) {
    return WithoutBytes(type);
  };
  ops.from_sample = [](const ddsi_sertype*, ddsi_serdata_kind, const void*) -> ddsi_serdata* {
    return nullptr;
  };
  ops.to_ser = [](const ddsi_serdata* sample, std::size_t from, std::size_t size, void* to) {
    std::memcpy(to, Of(sample).bytes.data() + from, size);
  };
  ops.to_ser_ref = [](const ddsi_serdata* sample, std::size_t from, std::size_t size,
                      ddsrt_iovec_t* lent) {
    lent->iov_base = const_cast<std::uint8_t*>(Of(sample).bytes.data() + from);
    lent->iov_len = size;
    return ddsi_serdata_ref(sample);
  };
  ops.to_ser_unref = [](ddsi_serdata* sample, const ddsrt_iovec_t*) { ddsi_serdata_unref(sample); };
  ops.to_sample = [](const ddsi_serdata*, void*, void**, void*) { return false; };
  ops.to_untyped = [](const ddsi_serdata* sample) {
    ddsi_serdata* untyped = WithoutBytes(sample->type);
    if (untyped != nullptr) untyped->type = nullptr;  // it may outlive the type
    return untyped;
  };
  ops.untyped_to_sample = [](const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) {
    return true;
  };
  ops.free = [](ddsi_serdata* sample) { delete &Of(sample); };
  ops.print = [](const ddsi_sertype*, const ddsi_serdata*, char* text, std::size_t) {
    text[0] = '\0';
    return std::size_t{0};
  };
  ops.get_keyhash = [](const ddsi_serdata*, ddsi_keyhash* hash, bool) { *hash = {}; };
  return ops;
}

constexpr ddsi_serdata_ops kSampleOps = MakeSampleOps();

constexpr ddsi_sertype_ops MakeTypeOps() {
  ddsi_sertype_ops ops{};
  ops.version = ddsi_sertype_v0;
  ops.free = [](ddsi_sertype* type) {
    ddsi_sertype_fini(type);
    delete type;
  };
  ops.zero_samples = [](const ddsi_sertype*, void*, std::size_t) {};
  ops.realloc_samples = [](void** samples, const ddsi_sertype*, void*, std::size_t,
                           std::size_t count) {
    for (void*& sample : std::span(samples, count)) sample = nullptr;
  };
  ops.free_samples = [](const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {};
  ops.equal = [](const ddsi_sertype*, const ddsi_sertype*) { return true; };  // names are compared
  ops.hash = [](const ddsi_sertype*) { return std::uint32_t{0}; };
  return ops;
}

constexpr ddsi_sertype_ops kTypeOps = MakeTypeOps();

}  // namespace

Entity SerializedTopic(const Participant& participant, const std::string& topic,
                       const std::string& type) {
  auto* sertype = new ddsi_sertype{};
  ddsi_sertype_init(sertype, type.c_str(), &kTypeOps, &kSampleOps, true);
  sertype->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  const dds_return_t handle = dds_create_topic_sertype(participant.handle(), topic.c_str(),
                                                       &sertype, nullptr, nullptr, nullptr);
  if (handle < 0) ddsi_sertype_unref(sertype);
  return Entity(Checked(handle, "creating topic " + topic));
}

}  // namespace telltale
