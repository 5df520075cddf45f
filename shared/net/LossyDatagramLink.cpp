#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "LossyLink.h"
#include "SplitMix64.h"

namespace naiad {
namespace {

using std::chrono::nanoseconds;
using Time = VirtualClock::Time;
using Receiver = std::function<void(std::string_view)>;

constexpr std::size_t kMaxPacket = 1200;  // bytes, see DatagramChannel::send

struct Direction {
  explicit Direction(std::uint64_t seed) : rng(seed) {}

  LinkConditions conditions;
  LinkCounters counters;
  SplitMix64 rng;  // one for each direction: traffic one way changes nothing the other way
  nanoseconds line_free{0};
  Time last_arrival{0};
  std::uint64_t newest_delivered = 0;  // number of the packet, counted from 1

  std::shared_ptr<Receiver> receiver;  // shared with the call that is running
  bool taken = false;                  // the sending end
};

std::size_t indexOf(LinkEnd end) {
  return end == LinkEnd::kClient ? 0 : 1;
}

Time jitterOf(Direction& direction) {
  const auto jitter = std::max<Time::rep>(direction.conditions.jitter.count(), 0);
  return Time(static_cast<Time::rep>(direction.rng.below(static_cast<std::uint64_t>(jitter) + 1)));
}

/// When the last byte has left, or nothing if the queue in front of the line is full.
bool leave(Direction& direction, Time now, std::size_t size, Time& departure) {
  departure = now;
  const LinkConditions& conditions = direction.conditions;
  if (conditions.rate == 0) return true;
  const nanoseconds start = std::max<nanoseconds>(now, direction.line_free);
  const double waiting =
      std::chrono::duration<double>(start - now).count() * static_cast<double>(conditions.rate);
  if (waiting + static_cast<double>(size) > static_cast<double>(conditions.queue)) return false;
  direction.line_free = start + nanoseconds(size * 1'000'000'000 / conditions.rate);
  departure = std::chrono::ceil<Time>(direction.line_free);
  return true;
}

}  // namespace

struct LossyDatagramLink::State : std::enable_shared_from_this<State> {
  State(VirtualClock& virtual_clock, std::uint64_t seed)
      : clock(virtual_clock), directions{Direction(seed), Direction(~seed)} {}

  void send(LinkEnd from, std::string_view packet);
  void scheduleArrival(Direction& direction, Time when, std::uint64_t number, std::string packet);
  void arrive(Direction& direction, std::uint64_t number, std::string_view packet);
  Direction& from(LinkEnd end) { return directions[indexOf(end)]; }
  Direction& to(LinkEnd end) { return directions[1 - indexOf(end)]; }

  VirtualClock& clock;
  std::array<Direction, 2> directions;  // by sending end
};

void LossyDatagramLink::State::send(LinkEnd end, std::string_view packet) {
  if (packet.size() > kMaxPacket) throw std::length_error("a packet may not exceed 1200 bytes");
  Direction& direction = from(end);
  const LinkConditions& conditions = direction.conditions;
  const std::uint64_t number = ++direction.counters.sent;
  // Always the same four draws, so that another loss rate leaves the other packets' fates alone.
  const bool lost = direction.rng.unit() < conditions.loss;
  const bool twice = direction.rng.unit() < conditions.duplicate;
  const Time delays[] = {conditions.delay + jitterOf(direction), conditions.delay + jitterOf(direction)};

  Time departure;
  if (!leave(direction, clock.now(), packet.size(), departure) || lost) {
    ++direction.counters.dropped;
    return;
  }
  scheduleArrival(direction, departure + delays[0], number, std::string(packet));
  if (!twice) return;
  ++direction.counters.duplicated;
  scheduleArrival(direction, departure + delays[1], number, std::string(packet));
}

void LossyDatagramLink::State::scheduleArrival(Direction& direction, Time when, std::uint64_t number,
                                               std::string packet) {
  if (!direction.conditions.reorder) when = std::max(when, direction.last_arrival);
  direction.last_arrival = std::max(when, direction.last_arrival);
  clock.schedule(when, [self = shared_from_this(), &direction, number, packet = std::move(packet)] {
    self->arrive(direction, number, packet);
  });
}

void LossyDatagramLink::State::arrive(Direction& direction, std::uint64_t number, std::string_view packet) {
  const auto receiver = direction.receiver;  // the call may destroy the end
  if (!receiver) {
    ++direction.counters.dropped;
    return;
  }
  ++direction.counters.delivered;
  if (number < direction.newest_delivered) ++direction.counters.reordered;
  direction.newest_delivered = std::max(direction.newest_delivered, number);
  if (*receiver) (*receiver)(packet);
}

class LossyDatagramLink::End : public DatagramChannel {
 public:
  End(std::shared_ptr<State> state, LinkEnd end) : state_(std::move(state)), end_(end) {}
  ~End() override { state_->to(end_).receiver.reset(); }

  void start(Receiver on_packet) override {
    state_->to(end_).receiver = std::make_shared<Receiver>(std::move(on_packet));
  }
  void send(std::string_view packet) override { state_->send(end_, packet); }
  std::string peerAddress() const override {
    return end_ == LinkEnd::kClient ? "virtual:server" : "virtual:client";
  }

 private:
  std::shared_ptr<State> state_;
  LinkEnd end_;
};

LossyDatagramLink::LossyDatagramLink(VirtualClock& clock, const LinkConditions& conditions,
                                     std::uint64_t seed)
    : state_(std::make_shared<State>(clock, seed)) {
  for (Direction& direction : state_->directions) direction.conditions = conditions;
}

LossyDatagramLink::~LossyDatagramLink() = default;

std::unique_ptr<DatagramChannel> LossyDatagramLink::takeEnd(LinkEnd end) {
  if (std::exchange(state_->from(end).taken, true)) throw std::logic_error("this end was taken already");
  return std::make_unique<End>(state_, end);
}

void LossyDatagramLink::setConditions(LinkEnd from, const LinkConditions& conditions) {
  state_->from(from).conditions = conditions;
}

const LinkCounters& LossyDatagramLink::counters(LinkEnd from) const {
  return state_->from(from).counters;
}

}  // namespace naiad
