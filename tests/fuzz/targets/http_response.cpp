// Answers of web servers: however the stream is split, the result is that of RFC 9112 for the whole stream,
// ambiguous answers are rejected, and no more is buffered than allowed.
//
//   input   limit of the head 2 | limit of the body 2 | how it is split 1 | how the connection ends 1 | the
//   stream
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "Target.h"
#include "shared/net/http/HttpResponseReader.h"

namespace naiad::fuzz {
namespace {

struct Outcome {
  bool done = false;
  HttpError error = HttpError::kNone;
  unsigned status = 0;
  std::string body;
  std::string behind;
  friend bool operator==(const Outcome&, const Outcome&) = default;
};

/// The end of the connection after the stream.
enum class Ending : std::uint8_t { kOpen, kInOrder, kBroken };

/// Finds the expected result: reads the whole stream at once by simple searches.
class Oracle {
 public:
  Oracle(const std::string& stream, const HttpLimits& limits, Ending ending)
      : m_stream(stream), m_limits(limits), m_ending(ending) {}

  Outcome read() {
    if (readHeads() && frame()) {
      m_outcome.done = true;
      m_outcome.behind = m_stream.substr(m_at);
    }
    if (!m_outcome.done && m_outcome.error == HttpError::kNone && m_ending != Ending::kOpen)
      m_outcome.error = HttpError::kTruncated;
    return m_outcome;
  }

 private:
  bool fail(HttpError error) {
    m_outcome.error = error;
    return false;
  }

  /// Reads the next line. False if it is incomplete, invalid, or longer than `m_left` bytes.
  bool line(std::string& into) {
    const std::size_t end = m_stream.find('\n', m_at);
    const std::size_t size = (end == std::string::npos ? m_stream.size() : end + 1) - m_at;
    if (size > m_left) return fail(HttpError::kHeadTooLong);
    if (end == std::string::npos) return false;
    into = m_stream.substr(m_at, size);
    m_at += size;
    m_left -= size;
    if (into.size() < 2 || into[into.size() - 2] != '\r') return fail(HttpError::kMalformed);
    into.resize(into.size() - 2);
    for (const char c : into)
      if (c != '\t' && (static_cast<unsigned char>(c) < 0x20 || c == 0x7f))
        return fail(HttpError::kMalformed);
    return true;
  }

  /// Returns the value if the line is this field, otherwise nullopt.
  static std::optional<std::string> valueOf(const std::string& line, std::string_view name) {
    if (line.size() <= name.size() || line[name.size()] != ':') return std::nullopt;
    for (std::size_t i = 0; i < name.size(); ++i)
      if ((line[i] | 0x20) != name[i] && line[i] != name[i]) return std::nullopt;
    const std::size_t first = line.find_first_not_of(" \t", name.size() + 1);
    if (first == std::string::npos) return "";
    return line.substr(first, line.find_last_not_of(" \t") - first + 1);
  }
  static bool isField(const std::string& line) {
    const std::size_t colon = line.find(':');
    return colon != std::string::npos && colon > 0 &&
           std::all_of(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(colon), [](unsigned char c) {
             return c > 0x20 && c < 0x7f &&
                    std::string_view("\"(),/:;<=>?@[\\]{}").find(static_cast<char>(c)) ==
                        std::string_view::npos;
           });
  }

  /// Reads all interim heads (1xx) and the final head.
  bool readHeads() {
    m_left = m_limits.head;
    do {
      if (!readHead()) return false;
    } while (m_outcome.status < 200 && m_outcome.status != 101);
    return true;
  }
  bool readHead() {
    std::string start;
    m_outcome.status = 0;
    m_lengths.clear();
    m_codings.clear();
    if (!line(start)) return false;
    if (start.empty()) return fail(HttpError::kMalformed);
    for (std::string field; line(field);) {
      if (field.empty()) return readStatus(start);
      if (!isField(field)) return fail(HttpError::kMalformed);
      if (const auto length = valueOf(field, "content-length")) m_lengths.push_back(*length);
      if (const auto coding = valueOf(field, "transfer-encoding")) m_codings.push_back(*coding);
    }
    return false;
  }
  bool readStatus(const std::string& start) {
    m_is_1_0 = start.starts_with("HTTP/1.0 ");
    const std::string digits = start.substr(std::min<std::size_t>(9, start.size()), 3);
    const bool is_status =
        digits.size() == 3 && digits[0] != '0' && digits.find_first_not_of("0123456789") == std::string::npos;
    const bool ends = start.size() == 12 || (start.size() > 12 && start[12] == ' ');
    if ((!m_is_1_0 && !start.starts_with("HTTP/1.1 ")) || !is_status || !ends)
      return fail(HttpError::kMalformed);
    m_outcome.status = static_cast<unsigned>(std::stoul(digits));
    return true;
  }

  bool take(std::uint64_t size) {
    if (size > m_limits.body - m_announced) return fail(HttpError::kBodyTooLong);
    m_announced += size;
    const std::string piece = m_stream.substr(m_at, static_cast<std::size_t>(size));
    m_outcome.body += piece;
    m_at += piece.size();
    return piece.size() == size;
  }
  static std::optional<std::uint64_t> number(const std::string& text, int base) {
    const char* const digits = base == 10 ? "0123456789" : "0123456789abcdefABCDEF";
    if (text.empty() || text.find_first_not_of(digits) != std::string::npos) return std::nullopt;
    const std::string shortest = text.substr(std::min(text.find_first_not_of('0'), text.size() - 1));
    if (shortest.size() > 20) return std::nullopt;
    const __uint128_t value = [&] {
      __uint128_t sum = 0;
      for (const char c : shortest)
        sum = sum * static_cast<unsigned>(base) +
              static_cast<unsigned>(c <= '9' ? c - '0' : (c | 0x20) - 'a' + 10);
      return sum;
    }();
    if (value > UINT64_MAX) return std::nullopt;
    return static_cast<std::uint64_t>(value);
  }

  bool frame() {
    if (m_lengths.size() + m_codings.size() > 1) return fail(HttpError::kMalformed);
    if (m_outcome.status == 101 || m_outcome.status == 204 || m_outcome.status == 304) return true;
    if (!m_codings.empty()) {
      std::string coding = m_codings[0];
      for (char& c : coding) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c | 0x20 : c);
      return coding == "chunked" && !m_is_1_0 ? readChunks() : fail(HttpError::kMalformed);
    }
    if (!m_lengths.empty()) {
      const auto length = number(m_lengths[0], 10);
      return length ? take(*length) : fail(HttpError::kMalformed);
    }
    take(std::min<std::uint64_t>(m_stream.size() - m_at, m_limits.body));
    if (m_at < m_stream.size()) return fail(HttpError::kBodyTooLong);
    return m_ending == Ending::kInOrder;
  }
  bool readChunks() {
    for (bool is_first = true;; is_first = false) {
      m_left = m_limits.head;
      std::string text;
      if (!is_first && (!line(text) || !text.empty()))
        return m_outcome.error == HttpError::kNone && !text.empty() ? fail(HttpError::kMalformed) : false;
      if (!line(text)) return false;
      text = text.substr(0, text.find(';'));
      while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.pop_back();
      const auto size = number(text, 16);
      if (!size) return fail(HttpError::kMalformed);
      if (*size == 0) return readTrailer();
      if (!take(*size)) return false;
    }
  }
  bool readTrailer() {
    for (std::string field; line(field);) {
      if (field.empty()) return true;
      if (!isField(field)) return fail(HttpError::kMalformed);
    }
    return false;
  }

  const std::string& m_stream;
  const HttpLimits m_limits;
  const Ending m_ending;
  Outcome m_outcome;
  std::size_t m_at = 0;
  std::size_t m_left = 0;
  std::uint64_t m_announced = 0;
  std::vector<std::string> m_lengths;
  std::vector<std::string> m_codings;
  bool m_is_1_0 = false;
};

void requireHead(const HttpHead& head) {
  for (const auto& [name, value] : head.fields) {
    REQUIRE(!name.empty() && name.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ :\t") == std::string::npos);
    REQUIRE(value.find_first_of("\r\n") == std::string::npos && value.find('\0') == std::string::npos);
    REQUIRE(value.empty() ||
            (value.find_first_not_of(" \t") == 0 && value.back() != ' ' && value.back() != '\t'));
    REQUIRE(head.count(name) >= 1 && (head.count(name) > 1 || head.value(name) == value));
    if (value.find(',') == std::string::npos && !value.empty()) REQUIRE(head.lists(name, value));
  }
}

Outcome cut(std::string_view stream, const HttpLimits& limits, Ending ending, std::uint8_t how) {
  HttpResponseReader reader(limits);
  Outcome outcome;
  const bool pops = (how & 1) != 0;
  forEachPiece(stream, how, [&](std::string_view piece) {
    reader.feed(piece);
    REQUIRE(reader.isDone() || reader.error() != HttpError::kNone || piece.empty());
    if (reader.isDone()) outcome.behind += piece;
    REQUIRE(reader.body().size() <= limits.body);
    if (pops) outcome.body += reader.popBody();
  });
  if (ending != Ending::kOpen) reader.feedEnd(ending == Ending::kInOrder);
  outcome.body += reader.body();
  outcome.done = reader.isDone();
  outcome.error = reader.error();
  if (reader.hasHead() || reader.isDone()) outcome.status = reader.status();
  if (reader.isDone()) requireHead(reader.head());
  return outcome;
}

}  // namespace

void tryInput(Script script) {
  HttpLimits limits;
  limits.head = script.number<std::uint16_t>();
  limits.body = script.number<std::uint16_t>();
  const std::uint8_t how = script.byte();
  const auto ending = static_cast<Ending>(script.below(3));
  const std::string stream = script.rest();
  Outcome outcome = cut(stream, limits, ending, how);
  Outcome expected = Oracle(stream, limits, ending).read();
  REQUIRE(outcome.done == expected.done && outcome.error == expected.error);
  if (!outcome.done) return;
  REQUIRE(outcome == expected);
  (void)HttpRequestLine::parse(stream.substr(0, stream.find("\r\n")));
}

}  // namespace naiad::fuzz
