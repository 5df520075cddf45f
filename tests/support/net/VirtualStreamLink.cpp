#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "shared/net/stream/Framing.h"
#include "shared/net/stream/TcpChannel.h"
#include "shared/values/SplitMix64.h"
#include "tests/support/net/LossyLink.h"

namespace naiad {
namespace {

using std::chrono::nanoseconds;
using Time = VirtualClock::Time;
using Callbacks = ReliableChannel::Callbacks;

constexpr std::size_t kSegment = 1448;  // bytes of payload in an Ethernet frame
constexpr Time kMinRetransmission = std::chrono::milliseconds(200);
constexpr Time kMaxRetransmission = std::chrono::seconds(10);

enum class Kind { kFrame, kEndOfStream, kReset };
enum class Phase { kOpen, kClosing, kClosed };

/// A transmitted unit: a frame, or one of two ways to end. The other end handles units in numerical order.
struct Item {
  Kind kind = Kind::kFrame;
  std::uint64_t number = 0;
  std::string frame;

  /// Bytes on the line; zero for an end.
  std::size_t size() const { return kind == Kind::kFrame ? kFrameHeaderSize + frame.size() : 0; }
};

/// SHA-256 over all arguments, in blocks. Behaves like a TLS exporter, but is not secret.
std::string secretFrom(std::uint64_t seed, std::string_view label, std::string_view context,
                       std::size_t bytes) {
  std::string secret;
  const std::string front = std::to_string(seed) + ' ' + std::to_string(bytes) + ' ' +
                            std::to_string(label.size()) + ' ' + std::string(label) + std::string(context);
  for (int block = 0; secret.size() < bytes; ++block) {
    const std::string text = std::to_string(block) + ' ' + front;
    std::array<unsigned char, 32> hash{};
    if (EVP_Digest(text.data(), text.size(), hash.data(), nullptr, EVP_sha256(), nullptr) != 1) return {};
    secret.append(hash.begin(), hash.end());
  }
  secret.resize(bytes);
  return secret;
}

}  // namespace

/// One end, and the direction from it to the other.
struct VirtualStreamLink::Side {
  explicit Side(std::uint64_t seed) : rng(seed) {}

  // State for sending.
  LinkConditions conditions;
  SplitMix64 rng;
  std::deque<Item> queue;  // the first may be on the line
  std::size_t queued = 0;  // bytes in the queue
  bool on_line = false;
  nanoseconds line_free{0};
  std::size_t under_way = 0;  // bytes sent and not acknowledged
  std::uint64_t numbered = 0;

  // State for receiving.
  std::map<std::uint64_t, Item> arrived;  // not consumed yet
  std::uint64_t consumed = 0;
  std::size_t receive_limit = TcpOptions{}.receive_limit;

  // State for closing.
  Phase phase = Phase::kOpen;
  CloseReason reason = CloseReason::kLocal;
  std::shared_ptr<Callbacks> callbacks;  // keeps them alive during a call
  bool taken = false;
};

struct VirtualStreamLink::State : std::enable_shared_from_this<State> {
  State(VirtualClock& virtual_clock, std::uint64_t link_seed)
      : clock(virtual_clock), seed(link_seed), sides{Side(link_seed), Side(~link_seed)} {}

  void start(Side& side, Callbacks callbacks);
  void send(Side& side, std::string_view frame);
  void close(Side& side);
  void abandon(Side& side);

  void push(Side& side, Kind kind, std::string_view frame);
  void pump(Side& side);
  void depart(Side& side);
  void transmit(Side& side, const Item& item, Time retry_after);
  void consume(Side& side);
  void take(Side& side, const Item& item);
  void finish(Side& side, CloseReason reason);
  void report(Side& side);

  template <class Action>
  void after(Time delay, Action action) {
    clock.schedule(clock.now() + delay, [self = shared_from_this(), action] { action(*self); });
  }
  Side& at(LinkEnd end) { return sides[end == LinkEnd::kClient ? 0 : 1]; }
  Side& opposite(const Side& side) { return sides[&side == &sides[0] ? 1 : 0]; }

  VirtualClock& clock;
  std::uint64_t seed;
  std::array<Side, 2> sides;
};

// Sending: queue, line, network.

void VirtualStreamLink::State::send(Side& side, std::string_view frame) {
  if (frame.empty() || frame.size() > kMaxFramePayload) throw std::length_error("no size for a frame");
  if (side.phase != Phase::kOpen) return;
  if (side.queued + kFrameHeaderSize + frame.size() > TcpOptions{}.send_cap)
    return finish(side, CloseReason::kOverflow);
  push(side, Kind::kFrame, frame);
}

void VirtualStreamLink::State::push(Side& side, Kind kind, std::string_view frame) {
  side.queue.push_back({kind, ++side.numbered, std::string(frame)});
  side.queued += side.queue.back().size();
  pump(side);
}

void VirtualStreamLink::State::pump(Side& side) {
  while (!side.queue.empty() && !side.on_line) {
    const std::size_t size = side.queue.front().size();
    if (side.under_way > 0 && side.under_way + size > side.conditions.window) return;
    if (side.conditions.rate == 0 || size == 0) {
      depart(side);
      continue;
    }
    const nanoseconds begin = std::max<nanoseconds>(clock.now(), side.line_free);
    side.line_free = begin + nanoseconds(size * 1'000'000'000 / side.conditions.rate);
    side.on_line = true;
    after(std::chrono::ceil<Time>(side.line_free) - clock.now(), [&side](State& state) {
      side.on_line = false;
      state.depart(side);
      state.pump(side);
    });
  }
}

void VirtualStreamLink::State::depart(Side& side) {
  const Item item = std::move(side.queue.front());
  side.queue.pop_front();
  side.queued -= item.size();
  side.under_way += item.size();
  transmit(side, item,
           std::max(kMinRetransmission, 2 * (side.conditions.delay + opposite(side).conditions.delay)));
}

void VirtualStreamLink::State::transmit(Side& side, const Item& item, Time retry_after) {
  Side& receiver = opposite(side);
  if (receiver.phase == Phase::kClosed) return;  // no acknowledgement, so stop retransmitting
  bool lost = false;
  for (std::size_t sent = 0; sent == 0 || sent < item.size(); sent += kSegment) {
    if (side.rng.unit() < side.conditions.loss) lost = true;
  }
  if (lost) {
    after(retry_after, [&side, item, retry_after](State& state) {
      state.transmit(side, item, std::min(2 * retry_after, kMaxRetransmission));
    });
    return;
  }
  const auto jitter = static_cast<std::uint64_t>(std::max<Time::rep>(side.conditions.jitter.count(), 0));
  const Time delay = side.conditions.delay + Time(static_cast<Time::rep>(side.rng.below(jitter + 1)));
  after(delay, [&receiver, item](State& state) {
    receiver.arrived.emplace(item.number, item);
    state.consume(receiver);
  });
}

// Receiving.

void VirtualStreamLink::State::start(Side& side, Callbacks callbacks) {
  if (side.callbacks) throw std::logic_error("the channel has already been started");
  side.callbacks = std::make_shared<Callbacks>(std::move(callbacks));
  if (side.phase == Phase::kClosed) return report(side);
  after(Time(0), [&side](State& state) { state.consume(side); });
}

/// Handles arrived items in order if the channel is started or closing.
void VirtualStreamLink::State::consume(Side& side) {
  while (side.callbacks || side.phase == Phase::kClosing) {
    if (side.phase == Phase::kClosed) return;
    const auto next = side.arrived.find(side.consumed + 1);
    if (next == side.arrived.end()) return;
    const Item item = std::move(next->second);
    side.arrived.erase(next);
    ++side.consumed;
    after(side.conditions.delay, [&sender = opposite(side), size = item.size()](State& state) {
      sender.under_way -= size;  // acknowledged
      state.pump(sender);
    });
    take(side, item);
  }
}

void VirtualStreamLink::State::take(Side& side, const Item& item) {
  const bool closing = side.phase == Phase::kClosing;
  if (item.kind == Kind::kReset) {
    finish(side, closing ? CloseReason::kLocal : CloseReason::kError);
  } else if (item.kind == Kind::kEndOfStream) {
    finish(side, closing ? CloseReason::kLocal : CloseReason::kPeer);
  } else if (!closing && item.frame.size() > side.receive_limit) {
    finish(side, CloseReason::kProtocol);
  } else if (!closing) {
    const auto callbacks = side.callbacks;  // the handler may destroy the channel
    if (callbacks->on_frame) callbacks->on_frame(item.frame);
  }
}

// Closing.

void VirtualStreamLink::State::close(Side& side) {
  if (side.phase != Phase::kOpen) return;
  side.phase = Phase::kClosing;
  push(side, Kind::kEndOfStream, {});
  after(TcpOptions{}.close_timeout, [&side](State& state) {
    if (side.phase == Phase::kClosing) state.finish(side, CloseReason::kLocal);
  });
  after(Time(0), [&side](State& state) { state.consume(side); });
}

void VirtualStreamLink::State::abandon(Side& side) {
  side.callbacks.reset();
  if (side.phase == Phase::kOpen) finish(side, CloseReason::kPeer);  // an orderly end, not a reset
}

void VirtualStreamLink::State::finish(Side& side, CloseReason reason) {
  if (side.phase == Phase::kClosed) return;
  side.phase = Phase::kClosed;
  side.reason = reason;
  while (side.queue.size() > (side.on_line ? 1u : 0u)) {  // drop what has not left
    side.queued -= side.queue.back().size();
    side.queue.pop_back();
    --side.numbered;
  }
  // If the end of the stream has left already, this item comes after it and the receiver ignores it.
  push(side, reason == CloseReason::kPeer ? Kind::kEndOfStream : Kind::kReset, {});
  side.arrived.clear();
  report(side);
}

void VirtualStreamLink::State::report(Side& side) {
  after(Time(0), [&side](State&) {
    const auto callbacks = std::move(side.callbacks);  // null if the channel was destroyed
    if (callbacks && callbacks->on_closed) callbacks->on_closed(side.reason);
  });
}

class VirtualStreamLink::Channel : public ReliableChannel {
 public:
  Channel(std::shared_ptr<State> state, LinkEnd end, std::string peer)
      : state_(std::move(state)), side_(state_->at(end)), peer_(std::move(peer)) {}
  ~Channel() override { state_->abandon(side_); }

  void start(Callbacks callbacks) override { state_->start(side_, std::move(callbacks)); }
  void send(std::string_view frame) override { state_->send(side_, frame); }
  std::size_t unsentBytes() const override { return side_.phase == Phase::kClosed ? 0 : side_.queued; }
  void close() override { state_->close(side_); }
  std::string peerAddress() const override { return peer_; }
  void setReceiveLimit(std::size_t bytes) override { side_.receive_limit = bytes; }
  std::string exportSecret(std::string_view label, std::string_view context,
                           std::size_t bytes) const override {
    return side_.phase == Phase::kClosed ? std::string() : secretFrom(state_->seed, label, context, bytes);
  }

 private:
  std::shared_ptr<State> state_;
  Side& side_;
  std::string peer_;
};

VirtualStreamLink::VirtualStreamLink(VirtualClock& clock, const LinkConditions& conditions,
                                     std::uint64_t seed)
    : state_(std::make_shared<State>(clock, seed)) {
  for (Side& side : state_->sides) side.conditions = conditions;
}

VirtualStreamLink::~VirtualStreamLink() = default;

std::unique_ptr<ReliableChannel> VirtualStreamLink::takeEnd(LinkEnd end, const std::string& peer) {
  if (std::exchange(state_->at(end).taken, true)) throw std::logic_error("this end was taken already");
  return std::make_unique<Channel>(state_, end, peer);
}

void VirtualStreamLink::setConditions(LinkEnd from, const LinkConditions& conditions) {
  state_->at(from).conditions = conditions;
}

void VirtualStreamLink::breakConnection() {
  for (Side& side : state_->sides) state_->finish(side, CloseReason::kError);
}

}  // namespace naiad
