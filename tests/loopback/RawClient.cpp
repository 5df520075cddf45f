#include "RawClient.h"

#include <asio/read.hpp>
#include <asio/write.hpp>
#include <chrono>

#include "shared/net/base/Limits.h"
#include "shared/net/stream/Framing.h"

namespace naiad::test {

RawClient::RawClient(std::uint16_t port) {
  m_socket.connect({asio::ip::address_v4::loopback(), port});
}

void RawClient::sendBytes(const std::string& bytes) {
  asio::error_code ignored;
  asio::write(m_socket, asio::buffer(bytes), ignored);
}

void RawClient::sendFrame(const std::string& payload) {
  std::string bytes;
  appendFrame(bytes, payload);
  sendBytes(bytes);
}

wire::ClientMessage RawClient::hello(const std::string& name) {
  wire::ClientMessage message;
  message.mutable_hello()->set_magic(kHelloMagic);
  message.mutable_hello()->set_protocol(kProtocolVersion);
  message.mutable_hello()->set_player_name(name);
  return message;
}

std::optional<std::string> RawClient::readExactly(std::size_t count) {
  std::string bytes(count, '\0');
  std::optional<asio::error_code> result;
  asio::async_read(m_socket, asio::buffer(bytes),
                   [&](const asio::error_code& error, std::size_t) { result = error; });
  m_context.restart();
  m_context.run_for(std::chrono::seconds(30));
  if (!result) {  // the buffer must outlive the read
    m_timed_out = true;
    m_socket.cancel();
    m_context.restart();
    m_context.run();
    return std::nullopt;
  }
  if (*result) return std::nullopt;
  return bytes;
}

std::optional<wire::ServerMessage> RawClient::receive() {
  const auto header = readExactly(2);
  if (!header) return std::nullopt;
  const auto low = static_cast<unsigned char>((*header)[0]);
  const auto high = static_cast<unsigned char>((*header)[1]);
  const auto payload = readExactly(low + 256u * high);
  wire::ServerMessage message;
  if (!payload || !message.ParseFromString(*payload)) return std::nullopt;
  return message;
}

bool RawClient::waitForHangup() {
  while (receive()) {
  }
  return !m_timed_out;
}

bool RawClient::finish() {
  asio::error_code ignored;
  m_socket.shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
  return waitForHangup();
}

void RawClient::reset() {
  m_socket.set_option(asio::socket_base::linger(true, 0));
  m_socket.close();
}

}  // namespace naiad::test
