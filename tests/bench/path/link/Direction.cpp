#include "Direction.h"

#include <algorithm>
#include <utility>

namespace bench::path {
namespace {

constexpr std::size_t kHeader = 20;  // length of an IPv4 header, in bytes
constexpr std::uint8_t kUdp = 17;

bool isUdp(std::span<const std::uint8_t> packet) {
  return packet[9] == kUdp;
}

}  // namespace

Direction::Direction(const DirectionOptions& options, DirectionCounters& counters)
    : m_options(options), m_counters(counters), m_random(options.seed) {}

void Direction::take(std::span<const std::uint8_t> packet, Nanoseconds now) {
  if (packet.size() < kHeader || packet[0] >> 4 != 4) return;
  m_counters.bytes += packet.size();
  ++m_counters.packets;
  if (m_options.block_udp && isUdp(packet)) {
    ++m_counters.blocked;
    return;
  }
  if (random() < m_options.loss) {
    ++m_counters.lost;
    return;
  }
  const auto left = leaves(packet.size(), now);
  if (!left) {
    ++m_counters.overflowed;
    return;
  }
  const Nanoseconds jitter(
      static_cast<std::int64_t>(random() * static_cast<double>(m_options.jitter.count())));
  Nanoseconds due = *left + m_options.delay + jitter;
  if (!m_flying.empty()) due = std::max(due, m_flying.back().due);
  m_flying.push_back({{packet.begin(), packet.end()}, due});
}

/// Returns when the last bit of a packet is on the wire; nullopt if the queue has no space for it.
std::optional<Nanoseconds> Direction::leaves(std::size_t bytes, Nanoseconds now) {
  if (m_options.rate_bit_s == 0) return now;
  const double nanos_per_byte = 8e9 / static_cast<double>(m_options.rate_bit_s);
  const Nanoseconds begin = std::max(now, m_busy_until);
  const double waiting = static_cast<double>((begin - now).count()) / nanos_per_byte;
  if (waiting + static_cast<double>(bytes) > static_cast<double>(m_options.queue_bytes)) return std::nullopt;
  m_busy_until = begin + Nanoseconds(static_cast<std::int64_t>(static_cast<double>(bytes) * nanos_per_byte));
  return m_busy_until;
}

std::optional<Nanoseconds> Direction::next() const {
  if (m_flying.empty()) return std::nullopt;
  return m_flying.front().due;
}

Direction::Delivery Direction::pop(Nanoseconds now) {
  if (m_flying.empty() || m_flying.front().due > now) return {};
  Delivery delivery = std::move(m_flying.front());
  m_flying.pop_front();
  return delivery;
}

}  // namespace bench::path
