#include "random_stream.hpp"

#include <cmath>
#include <numbers>

namespace blind::truth {
namespace {

std::uint64_t Mixed(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  return bits ^ (bits >> 31);
}

constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15u;

}  // namespace

RandomStream RandomStream::For(std::string_view purpose, std::uint64_t number) const {
  std::uint64_t seed = Mixed(state_ ^ Mixed(number + kGolden));
  for (const char letter : purpose) {
    seed = Mixed(seed + kGolden + static_cast<unsigned char>(letter));
  }
  return RandomStream(seed);
}

std::uint64_t RandomStream::Bits() {
  return Mixed(state_ += kGolden);
}

double RandomStream::Uniform(double from, double to) {
  return from + (to - from) * static_cast<double>(Bits() >> 11) * 0x1p-53;
}

double RandomStream::LogUniform(double from, double to) {
  return from * std::pow(to / from, Uniform(0.0, 1.0));
}

double RandomStream::Normal(double sigma) {
  const double radius = std::sqrt(-2.0 * std::log(Uniform(0x1p-53, 1.0)));
  return sigma * radius * std::cos(Angle());
}

std::size_t RandomStream::Below(std::size_t count) {
  return Bits() % count;
}

double RandomStream::Angle() {
  return Uniform(0.0, 2.0 * std::numbers::pi);
}

GaussMarkov::GaussMarkov(double sigma, double time_constant_s, RandomStream rng)
    : sigma_(sigma), time_constant_s_(time_constant_s), rng_(rng), value_(rng_.Normal(sigma)) {}

double GaussMarkov::Step(double dt_s) {
  const double kept = std::exp(-dt_s / time_constant_s_);
  value_ = kept * value_ + sigma_ * std::sqrt(1.0 - kept * kept) * rng_.Normal();
  return value_;
}

}  // namespace blind::truth
