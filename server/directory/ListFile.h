// The file of a list of servers: replaced in one step, by a thread of its own, so that a disk that stalls
// delays no player.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace naiad {

class ListFile {
 public:
  /// Writes the first text. Throws std::runtime_error if that fails.
  ListFile(std::string path, std::string text);
  /// Removes the file: a list that is not kept up leads to servers that are gone.
  ~ListFile();
  ListFile(const ListFile&) = delete;
  ListFile& operator=(const ListFile&) = delete;

  /// Written soon, if it is another one. Does not wait. Any thread.
  void setText(std::string text);
  /// What is new about writing, as a line of the log; else empty. Any thread.
  std::string takeNews();

 private:
  void run();
  void noteResult(const std::string& problem);

  const std::string m_path;
  std::mutex m_mutex;
  std::condition_variable m_wake;
  std::string m_text;
  std::string m_news;
  bool m_has_text = false;  ///< that is not written yet
  bool m_failing = false;
  bool m_stopping = false;
  std::thread m_thread;  ///< last: it uses the others
};

}  // namespace naiad
