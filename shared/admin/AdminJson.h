// The control socket's lines: one JSON object (RFC 8259) each, of kMaxControlLine bytes at most, ended by \n.
//
//   to the server    {"command":"ban","arguments":{"who":"Ann","for":"2h"}}
//   from the server  {"rows":[{"id":1,"name":"Ann"}],"more":true}      rows that do not fit one line
//                    {"ok":true,"text":"…","facts":{…},"rows":[…]}     ends the answer
//                    {"ok":false,"error":"…","candidates":["…"]}       the same, refused
//                    {"event":"log","text":"…"}  {"dropped":12}        after "watch"
//
// Reading is strict: other keys, the same key twice, nesting, and text that is no UTF-8 are errors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shared/admin/AdminAnswer.h"
#include "shared/admin/AdminRequest.h"

namespace naiad {

/// In bytes, without the end of the line.
inline constexpr std::size_t kMaxControlLine = 4096;

/// For one line, without its end. Throws AdminUsageError.
AdminRequest readRequestLine(std::string_view line);
std::string requestLine(const AdminRequest& request);

/// The lines of an answer, each with its end.
std::string answerLines(const AdminAnswer& answer);
/// {"event":KIND,"text":TEXT}; the text is cut where it would not fit.
std::string eventLine(std::string_view kind, std::string_view text);
/// So many events were left out.
std::string droppedLine(std::uint64_t count);

/// What dfctl reads: adds a line to an answer.
class AnswerReader {
 public:
  enum class Got { kMore, kAnswer, kEvent, kDropped, kNonsense };
  Got readLine(std::string_view line);
  /// After kAnswer.
  const AdminAnswer& answer() const { return m_answer; }
  /// After kEvent.
  const std::string& event() const { return m_event; }
  std::uint64_t dropped() const { return m_dropped; }

 private:
  AdminAnswer m_answer;
  std::string m_event;
  std::uint64_t m_dropped = 0;
};

/// An answer as one JSON value, for programs: the rows, the facts, or {"text":…}; {"error":…} if it is
/// refused.
std::string answerJson(const AdminAnswer& answer);

}  // namespace naiad
