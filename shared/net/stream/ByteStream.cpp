#include "shared/net/stream/ByteStream.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <sstream>
#include <utility>

#include "shared/net/base/AddressPrefix.h"

namespace naiad {
namespace {

using asio::ip::tcp;

constexpr int kNotSentLowWater = 4096;  // bytes the kernel takes beyond what it could send

}  // namespace

ByteStream::ByteStream(tcp::socket socket) : socket_(std::move(socket)) {
  // A socket that is broken already fails here and again, visibly, on the first read.
  std::error_code ignored;
  socket_.non_blocking(true, ignored);
  socket_.set_option(tcp::no_delay(true), ignored);
  setsockopt(socket_.native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kNotSentLowWater,
             sizeof kNotSentLowWater);
}

std::string ByteStream::exportSecret(std::string_view, std::string_view, std::size_t) const {
  return {};
}

std::string peerName(const tcp::socket& socket) {
  std::error_code error;
  const tcp::endpoint endpoint = socket.remote_endpoint(error);
  if (error) return "unknown";
  std::ostringstream text;
  text << tcp::endpoint(unmapped(endpoint.address()), endpoint.port());
  return text.str();
}

}  // namespace naiad
