// A file with the newest state of a program, for other programs, like a list for the web.
#pragma once

#include <mutex>
#include <string>

#include "shared/program/JobThread.h"

namespace naiad {

/// Replaces the file atomically, on a thread of its own, so a slow disk delays no one. Any thread may use it.
class PublishedFile {
 public:
  /// Writes the first text. Throws std::runtime_error if that fails. `what`: like "list", for messages.
  PublishedFile(const std::string& what, std::string path, std::string text);
  /// Removes the file, because an outdated one would mislead its readers.
  ~PublishedFile();
  PublishedFile(const PublishedFile&) = delete;
  PublishedFile& operator=(const PublishedFile&) = delete;

  /// Makes the thread write the text soon if it has changed, `always`, or if the last one was not written.
  /// Does not block.
  void setText(std::string text, bool always = false);
  /// Returns a log line, once, if writing has begun to fail (like a full disk) or works again; else "".
  std::string popLogMessage();

 private:
  std::string write(const std::string& text) const;
  void writeNext();

  const std::string m_path;
  const std::string m_name;  ///< like "list /path", for messages
  std::mutex m_mutex;
  std::string m_text;    ///< the newest text
  bool m_waits = false;  ///< m_text is not being written yet
  std::string m_log_message;
  bool m_failing = false;
  JobThread m_thread;
};

}  // namespace naiad
