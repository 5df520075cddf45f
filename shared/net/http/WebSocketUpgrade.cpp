#include "shared/net/http/WebSocketUpgrade.h"

#include <openssl/evp.h>
#include <openssl/rand.h>

#include <array>
#include <stdexcept>

namespace naiad {
namespace {

/// Appended to the key to compute Sec-WebSocket-Accept (RFC 6455 1.3).
constexpr std::string_view kAcceptSuffix = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";

std::string base64(std::string_view bytes) {
  std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');  // OpenSSL adds a zero
  const int size =
      EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                      reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()));
  text.resize(static_cast<std::size_t>(size));
  return text;
}

std::string sha1(const std::string& bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha1(), nullptr) != 1) return {};
  return {reinterpret_cast<const char*>(digest.data()), size};
}

void fillRandomly(char* bytes, int count) {
  if (RAND_bytes(reinterpret_cast<unsigned char*>(bytes), count) != 1)
    throw std::runtime_error("OpenSSL cannot generate random numbers.");
}

}  // namespace

WebSocketUpgrade::WebSocketUpgrade(std::string_view subprotocol, std::string_view key)
    : m_subprotocol(subprotocol), m_key(base64(key)) {}

void WebSocketUpgrade::addTo(HttpRequest& request) const {
  request.fields.insert(request.fields.end(), {{"Connection", "Upgrade"},
                                               {"Upgrade", "websocket"},
                                               {"Sec-WebSocket-Version", "13"},
                                               {"Sec-WebSocket-Key", m_key},
                                               {"Sec-WebSocket-Protocol", m_subprotocol}});
}

std::string WebSocketUpgrade::problem(unsigned status, const HttpHead& answer) const {
  if (status != 101) return "status " + std::to_string(status);
  const std::string accept = base64(sha1(m_key + std::string(kAcceptSuffix)));
  if (!equalsIgnoringCase(answer.value("upgrade"), "websocket") || !answer.lists("connection", "upgrade"))
    return "not a WebSocket";
  if (answer.count("sec-websocket-accept") != 1 || answer.value("sec-websocket-accept") != accept)
    return "wrong Sec-WebSocket-Accept";
  if (answer.count("sec-websocket-protocol") != 1 || answer.value("sec-websocket-protocol") != m_subprotocol)
    return "wrong subprotocol";
  if (answer.count("sec-websocket-extensions") != 0) return "unrequested extension";
  return {};
}

std::string randomWebSocketKey() {
  std::string key(16, '\0');
  fillRandomly(key.data(), static_cast<int>(key.size()));
  return key;
}

WebSocketFraming::Mask randomWebSocketMask() {
  WebSocketFraming::Mask mask{};
  fillRandomly(mask.data(), static_cast<int>(mask.size()));
  return mask;
}

}  // namespace naiad
