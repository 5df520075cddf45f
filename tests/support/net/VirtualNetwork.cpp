#include "tests/support/net/VirtualNetwork.h"

#include <cassert>
#include <map>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "shared/net/datagram/SealedHeader.h"
#include "tests/support/net/LossyLine.h"

namespace naiad {
namespace {

using OnPacket = DatagramSocket::OnPacket;
using Number = std::uint32_t;  // identifies a socket; in order of opening, never reused
using Pair = std::pair<Number, Number>;

struct Node {
  Endpoint address;
  bool blocked_out = false;
  bool blocked_in = false;
  std::shared_ptr<OnPacket> receiver;  // keeps it alive during a call
};

}  // namespace

struct VirtualNetwork::State : std::enable_shared_from_this<State> {
  State(VirtualClock& virtual_clock, const LinkConditions& link_conditions, std::uint64_t first_seed)
      : clock(virtual_clock), conditions(link_conditions), seed(first_seed) {}

  Number add(Endpoint address);
  void move(Number number, Endpoint address);
  void remove(Number number);
  void send(Number from, const Endpoint& to, std::string_view packet);
  void arrive(const Endpoint& from, const Endpoint& to, std::string_view packet);
  LossyLine& line(const Pair& pair);
  Node* at(const Endpoint& address);
  Endpoint freePort(Endpoint address);

  VirtualClock& clock;
  LinkConditions conditions;
  std::uint64_t seed;
  std::map<Number, Node> nodes;
  std::unordered_map<Endpoint, Number> addresses;
  std::map<Pair, LossyLine> lines;
  Tap tap;
  Number opened = 0;
  std::uint16_t next_port = 40'000;
};

Endpoint VirtualNetwork::State::freePort(Endpoint address) {
  if (address.port != 0) return address;
  do {
    address.port = next_port;
    next_port = next_port == 0xffff ? 40'000 : static_cast<std::uint16_t>(next_port + 1);
  } while (addresses.contains(address));
  return address;
}

Number VirtualNetwork::State::add(Endpoint address) {
  address = freePort(address);
  if (addresses.contains(address)) throw std::logic_error("the address is taken: " + toString(address));
  const Number number = ++opened;
  nodes[number].address = address;
  addresses[address] = number;
  return number;
}

void VirtualNetwork::State::move(Number number, Endpoint address) {
  address = freePort(address);
  if (addresses.contains(address)) throw std::logic_error("the address is taken: " + toString(address));
  Node& node = nodes.at(number);
  addresses.erase(node.address);
  node.address = address;
  addresses[address] = number;
}

void VirtualNetwork::State::remove(Number number) {
  addresses.erase(nodes.at(number).address);
  nodes.erase(number);
}

Node* VirtualNetwork::State::at(const Endpoint& address) {
  const auto found = addresses.find(address);
  return found == addresses.end() ? nullptr : &nodes.at(found->second);
}

LossyLine& VirtualNetwork::State::line(const Pair& pair) {
  const std::uint64_t own = std::uint64_t{pair.first} << 32 | pair.second;
  return lines.try_emplace(pair, conditions, SplitMix64(seed ^ own).next()).first->second;
}

void VirtualNetwork::State::send(Number from, const Endpoint& to, std::string_view packet) {
  const Node& sender = nodes.at(from);
  if (tap) tap(sender.address, to, packet);
  const auto target = addresses.find(to);
  if (target == addresses.end()) return;
  const LossyLine::Fate fate = line({from, target->second}).send(clock.now(), packet.size());
  if (sender.blocked_out) return;
  for (int i = 0; i < fate.copies; ++i) {
    clock.schedule(fate.arrivals[static_cast<std::size_t>(i)],
                   [self = shared_from_this(), source = sender.address, to, copy = std::string(packet)] {
                     self->arrive(source, to, copy);
                   });
  }
}

void VirtualNetwork::State::arrive(const Endpoint& from, const Endpoint& to, std::string_view packet) {
  const Node* const node = at(to);
  const auto receiver = node && !node->blocked_in ? node->receiver : nullptr;
  if (receiver) (*receiver)(Path{.local = to, .remote = from}, packet);
}

class VirtualNetwork::Socket : public DatagramSocket {
 public:
  Socket(std::shared_ptr<State> state, Number number) : state_(std::move(state)), number_(number) {}
  ~Socket() override { state_->remove(number_); }

  void start(OnPacket on_packet) override {
    auto& receiver = node().receiver;
    if (receiver) throw std::logic_error("the socket has already been started");
    receiver = std::make_shared<OnPacket>(std::move(on_packet));
  }
  void send(const Path& path, std::string_view packet) override {
    if (packet.empty() || packet.size() > kMaxDatagram) throw std::length_error("invalid datagram size");
    queue_.emplace_back(path.remote, packet);
  }
  void flush() override {
    for (const auto& [to, packet] : std::exchange(queue_, {})) state_->send(number_, to, packet);
  }
  void reopen() override {
    queue_.clear();
    Endpoint address = node().address;
    address.port = 0;
    state_->move(number_, address);
  }
  Endpoint localEndpoint() const override { return node().address; }

  Number number() const { return number_; }
  static Number numberOf(const State& state, const DatagramSocket& socket) {
    const auto* const own = dynamic_cast<const Socket*>(&socket);
    assert(own && own->state_.get() == &state);
    return own->number_;
  }

 private:
  Node& node() const { return state_->nodes.at(number_); }

  std::shared_ptr<State> state_;
  Number number_;
  std::vector<std::pair<Endpoint, std::string>> queue_;
};

VirtualNetwork::VirtualNetwork(VirtualClock& clock, const LinkConditions& conditions, std::uint64_t seed)
    : state_(std::make_shared<State>(clock, conditions, seed)) {}

VirtualNetwork::~VirtualNetwork() = default;

std::unique_ptr<DatagramSocket> VirtualNetwork::open(const Endpoint& address) {
  return std::make_unique<Socket>(state_, state_->add(address));
}

void VirtualNetwork::rebind(const DatagramSocket& socket, const Endpoint& address) {
  state_->move(Socket::numberOf(*state_, socket), address);
}

void VirtualNetwork::block(const DatagramSocket& socket, bool outgoing, bool incoming) {
  Node& node = state_->nodes.at(Socket::numberOf(*state_, socket));
  node.blocked_out = outgoing;
  node.blocked_in = incoming;
}

void VirtualNetwork::setConditions(const LinkConditions& conditions) {
  state_->conditions = conditions;
  for (auto& [pair, line] : state_->lines) line.setConditions(conditions);
}

void VirtualNetwork::setConditions(const DatagramSocket& from, const DatagramSocket& to,
                                   const LinkConditions& conditions) {
  state_->line({Socket::numberOf(*state_, from), Socket::numberOf(*state_, to)}).setConditions(conditions);
}

void VirtualNetwork::spoof(const Endpoint& from, const Endpoint& to, std::string_view packet) {
  state_->clock.schedule(state_->clock.now(), [state = state_, from, to, copy = std::string(packet)] {
    state->arrive(from, to, copy);
  });
}

void VirtualNetwork::setTap(Tap tap) {
  state_->tap = std::move(tap);
}

}  // namespace naiad
