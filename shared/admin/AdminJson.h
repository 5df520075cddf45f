// The lines of the control socket: one JSON object (RFC 8259) each, at most kMaxControlLine bytes, then \n.
//
//   to the server    {"command":"ban","arguments":{"who":"Ann","for":"2h"}}
//   from the server  {"rows":[{"id":1,"name":"Ann"}],"more":true}      some of the rows; more lines follow
//                    {"ok":true,"text":"…","facts":{…},"rows":[…]}     ends the answer
//                    {"ok":false,"error":"…","candidates":["…"]}       ends the answer to a refused command
//                    {"event":"log","text":"…"}  {"dropped":12}        after "watch"
//
// Requests are read strictly: other keys, duplicate keys, deeper nesting and invalid UTF-8 are errors.
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

/// Maximum length of a line in bytes, without its \n.
inline constexpr std::size_t kMaxControlLine = 4096;

/// Parses one request line without its \n. Throws AdminUsageError.
AdminRequest readRequestLine(std::string_view line);
std::string requestLine(const AdminRequest& request);

/// Returns the lines of an answer, each with its \n.
std::string answerLines(const AdminAnswer& answer);
/// Returns {"event":KIND,"text":TEXT}; a text that does not fit the line is shortened.
std::string eventLine(std::string_view kind, std::string_view text);
/// Returns {"dropped":COUNT}, a line that reports that this many events were dropped.
std::string droppedLine(std::uint64_t count);

/// Reads the lines of an answer, for dfctl.
class AnswerReader {
 public:
  enum class LineKind { kMore, kAnswer, kEvent, kDropped, kMalformed };
  LineKind readLine(std::string_view line);
  /// Returns the whole answer; valid after a line of kind kAnswer.
  const AdminAnswer& answer() const { return m_answer; }
  /// Returns the text of the event; valid after a line of kind kEvent.
  const std::string& event() const { return m_event; }
  std::uint64_t dropped() const { return m_dropped; }

 private:
  AdminAnswer m_answer;
  std::string m_event;
  std::uint64_t m_dropped = 0;
};

/// Returns an answer as one JSON value: the rows, the facts, {"text":…}, or {"error":…} for a refusal.
std::string answerJson(const AdminAnswer& answer);

}  // namespace naiad
