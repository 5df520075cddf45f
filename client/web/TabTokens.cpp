#include "client/web/TabTokens.h"

namespace naiad {
namespace {

constexpr std::string_view kDigits = "0123456789abcdef";
constexpr std::size_t kMaxToken = 64;

std::string toHex(std::string_view bytes) {
  std::string text;
  for (const char byte : bytes) {
    text += kDigits[static_cast<unsigned char>(byte) >> 4];
    text += kDigits[static_cast<unsigned char>(byte) & 15];
  }
  return text;
}

std::string fromHex(std::string_view text) {
  std::string bytes;
  if (text.size() % 2 != 0 || text.size() > 2 * kMaxToken) return {};
  for (std::size_t i = 0; i < text.size(); i += 2) {
    const std::size_t high = kDigits.find(text[i]);
    const std::size_t low = kDigits.find(text[i + 1]);
    if (high == std::string_view::npos || low == std::string_view::npos) return {};
    bytes += static_cast<char>(high << 4 | low);
  }
  return bytes;
}

}  // namespace

TabTokens::TabTokens(WebPort& port, std::string_view kept) : m_port(port), m_token(fromHex(kept)) {}

void TabTokens::save(SavedSession session, Time) {
  m_token = session.token;
  m_port.keepToken(toHex(m_token));
}

void TabTokens::remove() {
  m_token.clear();
  m_port.keepToken("");
}

}  // namespace naiad
