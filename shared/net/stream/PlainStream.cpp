#include "shared/net/stream/PlainStream.h"

#include <asio/buffer.hpp>

namespace naiad {
namespace {

using asio::ip::tcp;

bool mayTryAgain(const std::error_code& error) {
  return error == asio::error::would_block || error == asio::error::interrupted;
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

}  // namespace naiad
