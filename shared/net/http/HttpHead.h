// The head of an HTTP/1.1 message (RFC 9112): a start line and fields, read from pieces with a limit.
//
// Strict wherever lenient parsers have disagreed about a message: lines must end with CRLF. A CR or LF alone,
// folded lines (obs-fold), blanks around a field's name and other control characters are refused.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace naiad {

/// Reasons to refuse a message. After an error, a reader reads nothing more.
enum class HttpError {
  kNone,
  kMalformed,    ///< not HTTP/1.0 or 1.1, or ambiguous
  kHeadTooLong,  ///< the head or the framing of the body has more bytes than allowed
  kBodyTooLong,
  kTruncated,  ///< the connection ended within the message
};

/// Start line and fields of a message. The texts are the peer's bytes, without control characters but tabs.
struct HttpHead {
  std::string start_line;
  /// Names in lower case, values without blanks at their ends, in the order of the message.
  std::vector<std::pair<std::string, std::string>> fields;

  /// Returns the value of the first field of this name (lower case); empty if it is missing.
  std::string_view value(std::string_view name) const;
  std::size_t count(std::string_view name) const;
  /// True if the comma-separated lists in the fields of this name contain the element (RFC 9110 5.6.1), in
  /// upper or lower case.
  bool lists(std::string_view name, std::string_view element) const;
};

/// Extracts lines from pieces of a stream. Limits the bytes of all lines together.
class HttpLines {
 public:
  explicit HttpLines(std::size_t limit) : m_limit(limit) {}

  /// Removes bytes from the front of `bytes` until a line is complete. Returns it without its CRLF; the view
  /// is valid until the next call. Returns nullopt if `bytes` is used up, or after an error.
  std::optional<std::string_view> next(std::string_view& bytes);
  HttpError error() const { return m_error; }
  /// Resets the byte count for the limit; call only between two lines.
  void restart() { m_used = 0; }

 private:
  std::size_t m_limit;
  std::size_t m_used = 0;  // bytes of all lines since restart()
  std::string m_line;
  bool m_complete = false;  // m_line was returned; the next call clears it
  HttpError m_error = HttpError::kNone;
};

/// Reads one head.
///
///   HttpHeadReader reader(kMaxHead);
///   reader.feed(bytes);                         // until isDone() or error()
///   if (reader.isDone()) use(reader.head());    // `bytes` begins with what follows the head
class HttpHeadReader {
 public:
  /// `limit`: maximum bytes of the head, including its empty line.
  explicit HttpHeadReader(std::size_t limit) : m_lines(limit) {}

  /// Removes the bytes of the head from the front of `bytes`.
  void feed(std::string_view& bytes);
  bool isDone() const { return m_done; }
  HttpError error() const { return m_error; }
  const HttpHead& head() const { return m_head; }

 private:
  void handleLine(std::string_view line);

  HttpLines m_lines;
  HttpHead m_head;
  HttpError m_error = HttpError::kNone;
  bool m_has_start = false;
  bool m_done = false;
};

/// The start line of an HTTP/1.0 or 1.1 request (RFC 9112 3). The views point into the line.
struct HttpRequestLine {
  std::string_view method;
  std::string_view target;  ///< printable ASCII without blanks, not empty

  static std::optional<HttpRequestLine> parse(std::string_view line);
};

/// Parses a field line into name (in lower case) and value (RFC 9112 5); nullopt if it is invalid.
std::optional<std::pair<std::string, std::string>> parseHttpField(std::string_view line);
/// True for a valid method or field name (RFC 9110 5.6.2).
bool isHttpToken(std::string_view text);
/// True if the texts are equal except for the case of ASCII letters.
bool equalsIgnoringCase(std::string_view a, std::string_view b);

}  // namespace naiad
