#pragma once

#include <utility>

#include <dds/dds.h>

namespace telltale {

/// Owns one Cyclone DDS entity and what hangs below it.
class Entity {
 public:
  explicit Entity(dds_entity_t handle) : handle_(handle) {}
  Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
  Entity& operator=(Entity&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Entity() {
    if (handle_ > 0) dds_delete(handle_);
  }

  dds_entity_t handle() const { return handle_; }

 private:
  dds_entity_t handle_;
};

}  // namespace telltale
