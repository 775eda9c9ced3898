#include "telltale/client/bus/instance_limit.hpp"

#include "telltale/client/bus/bus_error.hpp"

namespace telltale {

void InstanceLimit::ApplyTo(const Entity& topic) {
  dds_topic_filter filter{};
  filter.mode = DDS_TOPIC_FILTER_SAMPLEINFO_ARG;
  filter.f.sampleinfo_arg = &InstanceLimit::Admits;
  filter.arg = this;
  Checked(dds_set_topic_filter_extended(topic.handle(), &filter), "limiting instances");
}

std::uint64_t InstanceLimit::TakeRefused() {
  const std::lock_guard lock(mutex_);
  return std::exchange(refused_, 0);
}

bool InstanceLimit::Admits(const dds_sample_info_t* sample, void* limit) {
  return static_cast<InstanceLimit*>(limit)->Admits(sample->instance_handle);
}

bool InstanceLimit::Admits(InstanceHandle instance) {
  const std::lock_guard lock(mutex_);
  if (admitted_.contains(instance)) return true;
  if (admitted_.size() < most_) return admitted_.insert(instance).second;
  ++refused_;
  return false;
}

}  // namespace telltale
