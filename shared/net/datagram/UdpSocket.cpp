#include "shared/net/datagram/UdpSocket.h"

#include <asio/io_context.hpp>
#include <asio/ip/udp.hpp>
#include <asio/ip/v6_only.hpp>
#include <cerrno>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace naiad {
namespace {

using asio::ip::udp;

constexpr int kBatchesPerWakeUp = 4;

int setOption(int descriptor, int level, int option, int value) {
  return ::setsockopt(descriptor, level, option, &value, sizeof value);
}

/// Sets the options. Returns false, with errno, if replies could leave from a wrong address or packets be
/// fragmented.
bool setOptions(int descriptor, bool six, const UdpOptions& options) {
  setOption(descriptor, SOL_SOCKET, SO_RCVBUF, options.buffer);
  setOption(descriptor, SOL_SOCKET, SO_SNDBUF, options.buffer);
  // Sends no fragments, and ignores ICMP messages that a packet was too big: any machine can send them.
  if (setOption(descriptor, IPPROTO_IP, IP_MTU_DISCOVER, IP_PMTUDISC_PROBE) != 0) return false;
  if (!six) return setOption(descriptor, IPPROTO_IP, IP_PKTINFO, 1) == 0;
  return setOption(descriptor, IPPROTO_IPV6, IPV6_MTU_DISCOVER, IPV6_PMTUDISC_PROBE) == 0 &&
         setOption(descriptor, IPPROTO_IPV6, IPV6_DONTFRAG, 1) == 0 &&
         setOption(descriptor, IPPROTO_IPV6, IPV6_RECVPKTINFO, 1) == 0;
}

std::error_code lastError() {
  return {errno, std::generic_category()};
}

}  // namespace

struct UdpSocket::State : std::enable_shared_from_this<State> {
  State(asio::io_context& context, UdpOptions udp_options)
      : socket(context), options(std::move(udp_options)) {}

  void open(std::uint16_t port);
  [[noreturn]] void fail(std::uint16_t port, std::error_code error);
  void wait();
  void receive();
  bool receiveBatch();

  udp::socket socket;
  UdpOptions options;
  Endpoint local;
  std::optional<UdpSendBatch> outgoing;
  std::optional<UdpReceiveBatch> incoming;
  OnPacket on_packet;  // stored here because a callback may destroy the socket
  bool started = false;
  std::uint64_t opened = 0;  // distinguishes waits on an earlier descriptor from those on this one
  UdpCounters counters;
};

void UdpSocket::State::open(std::uint16_t port) {
  std::error_code error;
  const auto address = asio::ip::make_address(options.address, error);
  if (error) {
    throw ListenError("\"" + options.address + "\" is not a numeric IPv4 or IPv6 address.",
                      std::make_error_code(std::errc::invalid_argument));
  }
  const udp::endpoint endpoint(address, port);
  const bool is_bound = options.inherited >= 0;
  if (is_bound) {
    socket.assign(endpoint.protocol(), std::exchange(options.inherited, -1), error);
  } else {
    socket.open(endpoint.protocol(), error);
  }
  if (error) fail(port, error);
  if (address.is_v6() && !is_bound) socket.set_option(asio::ip::v6_only(options.v6_only), error);
  if (!error && !setOptions(socket.native_handle(), address.is_v6(), options)) error = lastError();
  if (!error && !is_bound) socket.bind(endpoint, error);
  if (error) fail(port, error);
  local = *makeEndpoint(options.address, socket.local_endpoint().port());
  outgoing.emplace(address.is_v6());
  incoming.emplace(local.port);
  ++opened;
}

void UdpSocket::State::fail(std::uint16_t port, std::error_code error) {
  std::error_code ignored;
  socket.close(ignored);
  error.assign(error.value(), std::generic_category());  // Asio's codes never equal std::errc
  const std::string where = "UDP port " + std::to_string(port) + " on " + options.address;
  if (error == std::errc::address_in_use) {
    throw ListenError("Cannot listen: " + where + " is in use by another program.", error);
  }
  throw ListenError("Cannot listen on " + where + " (" + error.message() + ").", error);
}

void UdpSocket::State::wait() {
  socket.async_wait(udp::socket::wait_read,
                    [self = shared_from_this(), number = opened](const std::error_code& error) {
                      if (error == asio::error::operation_aborted || self->opened != number) return;
                      self->receive();
                    });
}

void UdpSocket::State::receive() {
  const std::uint64_t number = opened;
  for (int i = 0; i < kBatchesPerWakeUp; ++i) {
    if (!receiveBatch()) break;
  }
  if (socket.is_open() && opened == number) wait();
}

/// Receives one batch. Returns false if no packets are left, or the socket was destroyed or reopened.
bool UdpSocket::State::receiveBatch() {
  const int count = incoming->receive(socket.native_handle());
  if (count < 0) {
    ++counters.receive_errors;
    return true;  // each error is reported once; packets may follow
  }
  const std::uint64_t number = opened;
  for (int i = 0; i < count; ++i) {
    if (incoming->tooLarge(i)) {
      ++counters.too_large;
      continue;
    }
    ++counters.received;
    on_packet(incoming->path(i), incoming->packet(i));
    if (!socket.is_open() || opened != number) return false;
  }
  return count == static_cast<int>(kUdpBatch);
}

UdpSocket::UdpSocket(asio::io_context& context, UdpOptions options)
    : state_(std::make_shared<State>(context, std::move(options))) {
  state_->open(state_->options.port);
}

UdpSocket::~UdpSocket() {
  std::error_code ignored;
  state_->socket.close(ignored);
}

void UdpSocket::start(OnPacket on_packet) {
  if (state_->started) throw std::logic_error("the socket has already been started");
  state_->started = true;
  state_->on_packet = std::move(on_packet);
  state_->wait();
}

void UdpSocket::send(const Path& path, std::string_view packet) {
  if (packet.empty() || packet.size() > kMaxDatagram) throw std::length_error("invalid datagram size");
  if (!state_->socket.is_open() || !state_->outgoing->add(path, packet)) {
    ++state_->counters.send_errors;
    return;
  }
  if (state_->outgoing->full()) flush();
}

char* UdpSocket::nextPacket() {
  return state_->outgoing ? state_->outgoing->nextPacket() : nullptr;
}

void UdpSocket::flush() {
  if (state_->socket.is_open()) state_->outgoing->send(state_->socket.native_handle(), state_->counters);
}

void UdpSocket::reopen() {
  std::error_code ignored;
  state_->socket.close(ignored);
  state_->open(0);
  if (state_->started) state_->wait();
}

Endpoint UdpSocket::localEndpoint() const {
  return state_->local;
}

const UdpCounters& UdpSocket::counters() const {
  return state_->counters;
}

}  // namespace naiad
