#include <array>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "shared/net/datagram/SealedHeader.h"
#include "tests/support/net/LossyLine.h"
#include "tests/support/net/LossyLink.h"

namespace naiad {
namespace {

using Receiver = std::function<void(std::string_view)>;

struct Direction {
  Direction(const LinkConditions& conditions, std::uint64_t seed) : line(conditions, seed) {}

  LossyLine line;
  std::shared_ptr<Receiver> receiver;  // keeps it alive during a call
  bool taken = false;                  // the sending end is taken
};

std::size_t indexOf(LinkEnd end) {
  return end == LinkEnd::kClient ? 0 : 1;
}

}  // namespace

struct LossyDatagramLink::State : std::enable_shared_from_this<State> {
  State(VirtualClock& virtual_clock, const LinkConditions& conditions, std::uint64_t seed)
      : clock(virtual_clock), directions{Direction(conditions, seed), Direction(conditions, ~seed)} {}

  void send(LinkEnd from, std::string_view packet);
  void arrive(Direction& direction, std::uint64_t number, std::string_view packet);
  Direction& from(LinkEnd end) { return directions[indexOf(end)]; }
  Direction& to(LinkEnd end) { return directions[1 - indexOf(end)]; }

  VirtualClock& clock;
  std::array<Direction, 2> directions;  // indexed by sending end
};

void LossyDatagramLink::State::send(LinkEnd end, std::string_view packet) {
  if (packet.size() > kMaxDatagram) throw std::length_error("a packet may not exceed 1200 bytes");
  Direction& direction = from(end);
  const LossyLine::Fate fate = direction.line.send(clock.now(), packet.size());
  for (int i = 0; i < fate.copies; ++i) {
    clock.schedule(fate.arrivals[i], [self = shared_from_this(), &direction, number = fate.number,
                                      copy = std::string(packet)] { self->arrive(direction, number, copy); });
  }
}

void LossyDatagramLink::State::arrive(Direction& direction, std::uint64_t number, std::string_view packet) {
  const auto receiver = direction.receiver;  // the call may destroy the end
  if (!receiver) return direction.line.dropped();
  direction.line.delivered(number);
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
    : state_(std::make_shared<State>(clock, conditions, seed)) {}

LossyDatagramLink::~LossyDatagramLink() = default;

std::unique_ptr<DatagramChannel> LossyDatagramLink::takeEnd(LinkEnd end) {
  if (std::exchange(state_->from(end).taken, true)) throw std::logic_error("this end was taken already");
  return std::make_unique<End>(state_, end);
}

void LossyDatagramLink::setConditions(LinkEnd from, const LinkConditions& conditions) {
  state_->from(from).line.setConditions(conditions);
}

const LinkCounters& LossyDatagramLink::counters(LinkEnd from) const {
  return state_->from(from).line.counters();
}

}  // namespace naiad
