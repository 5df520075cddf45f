// Reads the answer to an HTTP/1.1 request (RFC 9112) from pieces, with limits. It has no socket and no clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "shared/net/http/HttpHead.h"

namespace naiad {

struct HttpLimits {
  /// Limit in bytes of the head and the interim answers before it; also of the lines between two chunks of a
  /// body, and of those after the last chunk.
  std::size_t head = std::size_t{16} * 1024;
  /// Limit in bytes of the whole body.
  std::uint64_t body = std::uint64_t{1} << 20;
  /// Value of `body` for an endless answer, whose pieces the caller removes.
  static constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();
};

/// One answer to a GET, POST or PATCH, but not to HEAD, whose answers announce a body that does not follow.
///
///   reader.feed(bytes);       // until isDone() or error()
///   reader.feedEnd(true);     // the connection ended
///
/// Interim answers (1xx) are skipped, except 101, after which the connection speaks another protocol. A body
/// is framed by Content-Length, by chunks, or by the end of the connection (RFC 9112 6.3). Refused as
/// malformed: more than one Content-Length, Content-Length together with Transfer-Encoding, other codings
/// than chunked, and chunks in HTTP/1.0.
///
/// The result does not depend on how the bytes are split into pieces. Memory: the head, and the received part
/// of the body that popBody() has not removed.
class HttpResponseReader {
 public:
  explicit HttpResponseReader(const HttpLimits& limits = {});

  /// Removes the answer's bytes from the front of `bytes`; the remaining bytes follow the answer.
  void feed(std::string_view& bytes);
  /// Call when the connection has ended. `in_order`: the peer marked the end (TLS: close_notify). If it did
  /// not, a body whose end is that of the connection counts as truncated.
  void feedEnd(bool in_order);

  bool isDone() const { return m_state == State::kDone; }
  HttpError error() const { return m_error; }

  /// True when the final head is complete; status() and head() are valid then.
  bool hasHead() const { return m_state > State::kHead; }
  unsigned status() const { return m_status; }
  const HttpHead& head() const { return m_head.head(); }

  /// The received part of the body that popBody() has not removed.
  const std::string& body() const { return m_body; }
  /// Removes and returns body(), for callers that use the body piece by piece.
  std::string popBody() { return std::exchange(m_body, {}); }

 private:
  // In all states after kHead, the head is complete (hasHead()).
  enum class State { kHead, kLength, kToEnd, kChunkSize, kChunk, kChunkEnd, kTrailer, kDone };

  void step(std::string_view& bytes);
  void readHead(std::string_view& bytes);
  void chooseFraming(bool is_1_0);
  void readBody(std::string_view& bytes);
  void readChunkSize(std::string_view line);
  void handleLine(std::string_view line);
  void begin(std::uint64_t bytes);
  void fail(HttpError error) { m_error = error; }

  HttpLimits m_limits;
  HttpHeadReader m_head;

  HttpLines m_lines;              // lines of a chunked body
  std::size_t m_interim = 0;      // bytes of interim heads
  std::uint64_t m_remaining = 0;  // missing bytes of this body or chunk; in kToEnd, bytes still allowed
  std::uint64_t m_total = 0;      // bytes of the body so far, including the announced chunk
  unsigned m_status = 0;
  State m_state = State::kHead;
  HttpError m_error = HttpError::kNone;
  std::string m_body;
};

}  // namespace naiad
