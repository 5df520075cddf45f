#include "client/lan/ServerListJson.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <variant>

#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"
#include "shared/net/stream/JoinLink.h"
#include "shared/values/Canvas.h"

namespace naiad {
namespace {

constexpr int kMaxDepth = 8;
constexpr std::size_t kMaxNumber = 64;  // characters

/// What a member may be; arrays, objects and null are read and forgotten.
using Value = std::variant<std::monostate, bool, double, std::string>;

/// Goes through a text once, from the front. A step returns false at the first thing that is no JSON.
class JsonReader {
 public:
  explicit JsonReader(std::string_view text) : m_left(text) {}

  bool readList(FoundServers& servers) {
    skipBlanks();
    const bool good = peek() == '[' ? readArray(&servers, 1) : readServer(servers, 1);
    skipBlanks();
    return good && m_left.empty();
  }

 private:
  char peek() const { return m_left.empty() ? '\0' : m_left.front(); }
  void skipBlanks() { m_left.remove_prefix(std::min(m_left.find_first_not_of(" \t\r\n"), m_left.size())); }
  bool take(std::string_view word) {
    if (!m_left.starts_with(word)) return false;
    m_left.remove_prefix(word.size());
    return true;
  }
  bool takeMark(char mark) {
    skipBlanks();
    return take({&mark, 1});
  }

  /// `p_servers`: where the servers of the outermost array go; null for others.
  bool readArray(FoundServers* p_servers, int depth) {
    if (depth > kMaxDepth || !takeMark('[')) return false;
    if (takeMark(']')) return true;
    do {
      skipBlanks();
      Value ignored;
      if (!(p_servers != nullptr ? readServer(*p_servers, depth + 1) : readValue(ignored, depth + 1)))
        return false;
    } while (takeMark(','));
    return takeMark(']');
  }

  /// Calls take_member(name, value) for each.
  template <class TakeMember>
  bool readObject(int depth, TakeMember take_member) {
    if (depth > kMaxDepth || !takeMark('{')) return false;
    if (takeMark('}')) return true;
    do {
      skipBlanks();
      std::string name;
      Value value;
      if (!readString(name) || !takeMark(':')) return false;
      skipBlanks();
      if (!readValue(value, depth + 1)) return false;
      take_member(name, value);
    } while (takeMark(','));
    return takeMark('}');
  }

  bool readValue(Value& value, int depth) {
    switch (peek()) {
      case '{':
        return readObject(depth, [](const std::string&, const Value&) {});
      case '[':
        return readArray(nullptr, depth);
      case '"':
        return readString(value.emplace<std::string>());
      case 't':
        value = true;
        return take("true");
      case 'f':
        value = false;
        return take("false");
      case 'n':
        return take("null");
      default:
        return readNumber(value);
    }
  }

  std::size_t takeDigits() {
    const std::size_t count = std::min(m_left.find_first_not_of("0123456789"), m_left.size());
    m_left.remove_prefix(count);
    return count;
  }

  bool readNumber(Value& value) {
    const std::string_view begin = m_left;
    take("-");
    if (!take("0") && takeDigits() == 0) return false;
    if (take(".") && takeDigits() == 0) return false;
    if (take("e") || take("E")) {
      if (!take("+")) take("-");
      if (takeDigits() == 0) return false;
    }
    const std::string number(begin.substr(0, begin.size() - m_left.size()));
    if (number.size() > kMaxNumber) return false;
    value = std::strtod(number.c_str(), nullptr);
    return true;
  }

  bool readString(std::string& text) {
    if (!take("\"")) return false;
    while (!m_left.empty()) {
      const char c = m_left.front();
      m_left.remove_prefix(1);
      if (c == '"') return true;
      if (static_cast<unsigned char>(c) < ' ') return false;
      if (c != '\\') {
        text.push_back(c);
      } else if (!readEscape(text)) {
        return false;
      }
    }
    return false;
  }

  bool readEscape(std::string& text) {
    constexpr std::string_view kNames = "\"\\/bfnrt";
    constexpr std::string_view kMeanings = "\"\\/\b\f\n\r\t";
    if (take("u")) return readUnit(text);
    const std::size_t which = kNames.find(peek());
    if (m_left.empty() || which == std::string_view::npos) return false;
    text.push_back(kMeanings[which]);
    m_left.remove_prefix(1);
    return true;
  }

  std::optional<unsigned> takeHex() {
    unsigned unit = 0;
    if (m_left.size() < 4) return std::nullopt;
    for (const char c : m_left.substr(0, 4)) {
      const char lower = c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : c;
      const std::size_t digit = std::string_view("0123456789abcdef").find(lower);
      if (digit == std::string_view::npos) return std::nullopt;
      unit = unit * 16 + static_cast<unsigned>(digit);
    }
    m_left.remove_prefix(4);
    return unit;
  }

  /// \uXXXX, or two for a character beyond 16 bits. A half of one is U+FFFD.
  bool readUnit(std::string& text) {
    const auto first = takeHex();
    if (!first) return false;
    char32_t ch = *first;
    if (*first >= 0xd800 && *first < 0xdc00 && m_left.starts_with("\\u")) {
      take("\\u");
      const auto second = takeHex();
      if (!second) return false;
      const bool is_pair = *second >= 0xdc00 && *second < 0xe000;
      ch = is_pair ? 0x10000 + ((*first - 0xd800) << 10) + (*second - 0xdc00) : 0xfffd;
    } else if (*first >= 0xd800 && *first < 0xe000) {
      ch = 0xfffd;
    }
    df::appendUtf8(text, ch);
    return true;
  }

  bool readServer(FoundServers& servers, int depth);

  std::string_view m_left;
};

std::string textOf(const Value& value) {
  const auto* p_text = std::get_if<std::string>(&value);
  return p_text != nullptr ? safeText(*p_text, kMaxLanText) : "";
}

std::uint16_t countOf(const Value& value) {
  const auto* p_number = std::get_if<double>(&value);
  constexpr double kMost = std::numeric_limits<std::uint16_t>::max();
  return p_number != nullptr ? static_cast<std::uint16_t>(std::clamp(*p_number, 0.0, kMost)) : 0;
}

bool JsonReader::readServer(FoundServers& servers, int depth) {
  FoundServer server;
  server.protocol = kProtocolVersion;  // unless it says another one
  bool has_link = false;
  const bool good = readObject(depth, [&](const std::string& name, const Value& value) {
    if (name == "name") server.name = textOf(value);
    if (name == "game") server.game = textOf(value);
    if (name == "players") server.players = countOf(value);
    if (name == "max_players") server.max_players = countOf(value);
    if (name == "protocol") server.protocol = countOf(value);
    if (name == "password")
      server.asks_password = std::get_if<bool>(&value) != nullptr && std::get<bool>(value);
    const auto* p_text = std::get_if<std::string>(&value);
    if (name != "link" || p_text == nullptr) return;
    const auto parsed = JoinLink::parse(*p_text);
    const auto* p_link = std::get_if<JoinLink>(&parsed);
    has_link = p_link != nullptr && p_link->room.empty();
    if (!has_link) return;
    server.where = {p_link->where.host, p_link->where.port};
    server.key = p_link->key;
  });
  if (good && has_link) servers.addServer(server);
  return good;
}

}  // namespace

std::optional<FoundServers> readServerList(std::string_view json) {
  FoundServers servers;
  if (!JsonReader(json).readList(servers)) return std::nullopt;
  return servers;
}

}  // namespace naiad
