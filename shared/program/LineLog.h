// Log lines with the time of day, to a file or stderr, by a thread of their own: callers never wait.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace naiad {

/// Something worth a line of the log: a sentence for people, and the facts in it by name for programs.
/// The text format writes the sentence, the JSON format the sentence and the facts: both come from one event,
/// so that they cannot differ. A plain text is an event, too.
struct LogEvent {
  enum class Level { kError, kWarning, kInfo };
  /// Names are written as they are; values are escaped.
  using Fields = std::vector<std::pair<std::string, std::string>>;

  LogEvent(std::string sentence) : text(std::move(sentence)) {}  // NOLINT(google-explicit-constructor)
  LogEvent(const char* p_sentence) : text(p_sentence) {}         // NOLINT(google-explicit-constructor)
  LogEvent(Level how_bad, std::string sentence) : level(how_bad), text(std::move(sentence)) {}
  /// `what`: a literal, "joined". `sentence` has the fields' values in it.
  LogEvent(const char* what, std::string sentence, Fields facts)
      : name(what), text(std::move(sentence)), fields(std::move(facts)) {}
  /// For people the sentence stands behind "warning: ".
  static LogEvent warning(const std::string& sentence) { return {Level::kWarning, "warning: " + sentence}; }
  operator const std::string&() const { return text; }  // NOLINT(google-explicit-constructor)

  const char* name = "note";
  Level level = Level::kInfo;
  std::string text;
  Fields fields;
};

/// How an event of the log becomes a line.
enum class LogFormat {
  kText,  ///< "2026-01-31 13:59:59 sentence", in local time
  kBare,  ///< "sentence"
  kJson,  ///< {"time":"2026-01-31T12:59:59.123Z","level":"info","event":"note","text":"sentence",…}
};

/// The event as a line that ends with \n, of at most `max_bytes` (512 or more) bytes: sentences that are
/// longer are cut off. Control characters are escaped; JSON stays valid whatever the bytes are.
std::string formatEvent(const LogEvent& event, LogFormat format, std::chrono::system_clock::time_point time,
                        std::size_t max_bytes);

/// Where log lines go.
using LogLine = std::function<void(const LogEvent& event)>;

/// A reader that stalls, a full disk or a pipe without a reader costs lines and never time: what does not fit
/// in kMaxWaiting is dropped, writing is tried again, and once it works a line says how many were lost.
class LineLog {
 public:
  /// Who writes. A world in a process of its own has no further threads: there each line is written by its
  /// caller, or dropped where that would wait; the time is the front's to add, which copies it into its log.
  enum class Writer { kThread, kCaller };

  /// Bytes of lines that wait to be written, at most.
  static constexpr std::size_t kMaxWaiting = std::size_t{1} << 20;
  /// Bytes of one line, at most; the rest is cut off. So a pipe takes each line as a whole.
  static constexpr std::size_t kMaxLine = 2048;

  /// Append to this file, made with mode 0640; empty: stderr. Throws std::runtime_error if it cannot be
  /// written, or is a folder or a pipe.
  explicit LineLog(const std::string& path, Writer writer = Writer::kThread);
  /// Waits a second, at most, for what has not been written.
  ~LineLog();
  LineLog(const LineLog&) = delete;
  LineLog& operator=(const LineLog&) = delete;

  /// Log a line; control characters in it are escaped. Any thread.
  void operator()(const LogEvent& event);
  /// From the next line on. Any thread.
  void setFormat(LogFormat format);
  /// Log what is as bad as this, or worse; at first everything. Any thread.
  void setLevel(LogEvent::Level least);
  /// What the lines are written to. Stays the same when the file is opened again.
  int descriptor() const;

  /// Every log of this process opens its file again before its next line, as after a rotation of logs. Any
  /// thread.
  static void reopenAll();
  /// Wait until all logs of this process have written their lines, or for so long. Any thread.
  static void waitUntilWritten(std::chrono::milliseconds most);

 private:
  struct Shared;
  std::shared_ptr<Shared> m_shared;  ///< the thread's, too: it may outlive this in a write that does not end
};

}  // namespace naiad
