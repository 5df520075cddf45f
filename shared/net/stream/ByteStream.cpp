#include "shared/net/stream/ByteStream.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <asio/buffer.hpp>
#include <cstring>
#include <sstream>
#include <utility>

#include "shared/net/base/AddressPrefix.h"

namespace naiad {
namespace {

using asio::ip::tcp;

bool mayTryAgain(const std::error_code& error) {
  return error == asio::error::would_block || error == asio::error::interrupted;
}

constexpr int kNotSentLowWater = 4096;  // with this many unsent bytes, the kernel accepts no more

std::string peerOf(const ByteStream::Socket& socket) {
  std::error_code error;
  const auto generic = socket.remote_endpoint(error);
  tcp::endpoint endpoint;
  const int family = error ? AF_UNSPEC : generic.data()->sa_family;
  if (family != AF_INET && family != AF_INET6) return "unknown";
  std::memcpy(endpoint.data(), generic.data(), std::min(generic.size(), endpoint.capacity()));
  return peerName(endpoint);
}

}  // namespace

ByteStream::Progress PlainStream::read(std::span<char> into) {
  std::error_code error;
  const std::size_t size = socket().read_some(asio::buffer(into.data(), into.size()), error);
  if (!error) return {Outcome::kDone, size};
  if (mayTryAgain(error)) return {Outcome::kWantsRead};
  return {error == asio::error::eof ? Outcome::kEnd : Outcome::kBroken};
}

ByteStream::Progress PlainStream::write(std::string_view bytes) {
  std::error_code error;
  const std::size_t size = socket().write_some(asio::buffer(bytes), error);
  if (!error) return {Outcome::kDone, size};
  return {mayTryAgain(error) ? Outcome::kWantsWrite : Outcome::kBroken};
}

ByteStream::Outcome PlainStream::end() {
  std::error_code error;
  socket().shutdown(tcp::socket::shutdown_send, error);
  return error ? Outcome::kBroken : Outcome::kDone;
}

ByteStream::ByteStream(Socket socket, std::string peer) : socket_(std::move(socket)), peer_(std::move(peer)) {
  if (peer_.empty()) peer_ = peerOf(socket_);
  // The calls below fail on a broken socket; the first read then reports the error.
  std::error_code ignored;
  socket_.non_blocking(true, ignored);
  socket_.set_option(tcp::no_delay(true), ignored);
  setsockopt(socket_.native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kNotSentLowWater,
             sizeof kNotSentLowWater);
}

std::string ByteStream::exportSecret(std::string_view, std::string_view, std::size_t) const {
  return {};
}

std::string peerName(const tcp::endpoint& endpoint) {
  std::ostringstream text;
  text << tcp::endpoint(unmapped(endpoint.address()), endpoint.port());
  return text.str();
}

}  // namespace naiad
