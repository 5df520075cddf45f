#include "shared/net/http/HttpResponseReader.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "shared/net/base/SafeText.h"

namespace naiad {
namespace {

struct StatusLine {
  bool is_1_0 = false;
  unsigned status = 0;
};

/// Parses "HTTP/1.1 200 OK", "HTTP/1.0 200 " or "HTTP/1.1 200".
std::optional<StatusLine> parseStatusLine(std::string_view line) {
  constexpr std::size_t kStatus = std::string_view("HTTP/1.1 ").size();
  const bool is_1_0 = line.starts_with("HTTP/1.0 ");
  if (!is_1_0 && !line.starts_with("HTTP/1.1 ")) return std::nullopt;
  const std::string_view digits = line.substr(kStatus, 3);
  const auto status = readNumber(digits, 100u, 999u);
  const std::string_view rest = line.substr(kStatus + digits.size());
  if (!status || (!rest.empty() && !rest.starts_with(' '))) return std::nullopt;
  return StatusLine{is_1_0, *status};
}

/// Parses the whole `text` as a number in this base.
std::optional<std::uint64_t> parseNumber(std::string_view text, int base) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

HttpResponseReader::HttpResponseReader(const HttpLimits& limits)
    : m_limits(limits), m_head(limits.head), m_lines(limits.head) {}

void HttpResponseReader::feed(std::string_view& bytes) {
  while (m_error == HttpError::kNone && m_state != State::kDone && !bytes.empty()) step(bytes);
}

void HttpResponseReader::step(std::string_view& bytes) {
  if (m_state == State::kHead) return readHead(bytes);
  if (m_state == State::kLength || m_state == State::kToEnd || m_state == State::kChunk)
    return readBody(bytes);
  const auto line = m_lines.next(bytes);
  fail(m_lines.error());
  if (line) handleLine(*line);
}

void HttpResponseReader::readHead(std::string_view& bytes) {
  const std::size_t before = bytes.size();
  m_head.feed(bytes);
  m_interim += before - bytes.size();
  fail(m_head.error());
  if (!m_head.isDone() || m_error != HttpError::kNone) return;
  const auto line = parseStatusLine(m_head.head().start_line);
  if (!line) return fail(HttpError::kMalformed);
  if (line->status < 200 && line->status != 101) {
    m_head = HttpHeadReader(m_limits.head - m_interim);
    return;
  }
  m_status = line->status;
  chooseFraming(line->is_1_0);
}

/// Determines where the body ends (RFC 9112 6.3).
void HttpResponseReader::chooseFraming(bool is_1_0) {
  const HttpHead& head = m_head.head();
  const std::size_t codings = head.count("transfer-encoding");
  const std::size_t lengths = head.count("content-length");
  if (codings + lengths > 1) return fail(HttpError::kMalformed);
  if (m_status == 101 || m_status == 204 || m_status == 304) {
    m_state = State::kDone;
  } else if (codings == 1) {
    if (is_1_0 || !equalsIgnoringCase(head.value("transfer-encoding"), "chunked"))
      return fail(HttpError::kMalformed);
    m_state = State::kChunkSize;
  } else if (lengths == 1) {
    const auto length = parseNumber(head.value("content-length"), 10);
    if (!length) return fail(HttpError::kMalformed);
    m_state = *length == 0 ? State::kDone : State::kLength;
    begin(*length);
  } else {
    m_state = State::kToEnd;
    m_remaining = m_limits.body;
  }
}

/// Expects this many more bytes of the body.
void HttpResponseReader::begin(std::uint64_t bytes) {
  if (bytes > m_limits.body - m_total && m_limits.body != HttpLimits::kUnlimited)
    return fail(HttpError::kBodyTooLong);
  m_total += bytes;
  m_remaining = bytes;
}

void HttpResponseReader::readBody(std::string_view& bytes) {
  const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(m_remaining, bytes.size()));
  m_body.append(bytes.substr(0, size));
  bytes.remove_prefix(size);
  if (m_remaining != HttpLimits::kUnlimited) m_remaining -= size;
  if (m_state == State::kToEnd) {
    if (!bytes.empty()) fail(HttpError::kBodyTooLong);
  } else if (m_remaining == 0) {
    m_state = m_state == State::kChunk ? State::kChunkEnd : State::kDone;
    m_lines.restart();
  }
}

/// Handles a line of a chunked body (RFC 9112 7.1). Chunk extensions and trailers are ignored.
void HttpResponseReader::handleLine(std::string_view line) {
  if (m_state == State::kChunkSize) {
    readChunkSize(line);
  } else if (m_state == State::kChunkEnd) {
    line.empty() ? static_cast<void>(m_state = State::kChunkSize) : fail(HttpError::kMalformed);
  } else if (line.empty()) {
    m_state = State::kDone;
  } else if (!parseHttpField(line)) {
    fail(HttpError::kMalformed);
  }
}

void HttpResponseReader::readChunkSize(std::string_view line) {
  std::string_view digits = line.substr(0, std::min(line.find(';'), line.size()));
  while (digits.ends_with(' ') || digits.ends_with('\t')) digits.remove_suffix(1);
  const auto size = parseNumber(digits, 16);
  if (!size) return fail(HttpError::kMalformed);
  m_state = *size == 0 ? State::kTrailer : State::kChunk;
  begin(*size);
}

void HttpResponseReader::feedEnd(bool in_order) {
  if (m_error != HttpError::kNone || m_state == State::kDone) return;
  if (m_state == State::kToEnd && in_order) {
    m_state = State::kDone;
  } else {
    fail(HttpError::kTruncated);
  }
}

}  // namespace naiad
