#include "telltale/service/web/bounded_connections.hpp"

#include <utility>

namespace telltale {

BoundedConnections::BoundedConnections(std::size_t limit) : idle_(limit) {
  for (std::size_t i = 0; i < limit; ++i) threads_.emplace_back([this] { Run(); });
}

void BoundedConnections::enqueue(std::function<void()> serve) {
  std::unique_lock lock(mutex_);
  taken_.wait(lock, [this] { return stopping_ || idle_ > 0; });
  if (!stopping_) --idle_;
  waiting_.push_back(std::move(serve));
  queued_.notify_one();
}

/// What waits is served before the threads end, since serving closes the connection.
void BoundedConnections::shutdown() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  queued_.notify_all();
  taken_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void BoundedConnections::Run() {
  std::unique_lock lock(mutex_);
  while (true) {
    queued_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    const auto serve = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    serve();
    lock.lock();
    ++idle_;
    taken_.notify_one();
  }
}

}  // namespace telltale
