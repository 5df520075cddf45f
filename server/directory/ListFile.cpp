#include "server/directory/ListFile.h"

#include <unistd.h>

#include <chrono>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "shared/net/base/SafeFile.h"

namespace naiad {
namespace {

constexpr std::chrono::seconds kAgain{2};  ///< after a failure

/// Empty if it was written.
std::string writeProblem(const std::string& path, const std::string& text) {
  try {
    publishFile(path, text);
  } catch (const std::system_error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

ListFile::ListFile(std::string path, std::string text) : m_path(std::move(path)), m_text(std::move(text)) {
  if (const std::string problem = writeProblem(m_path, m_text); !problem.empty())
    throw std::runtime_error("The list " + m_path + " cannot be written: " + problem);
  m_thread = std::thread([this] { run(); });
}

ListFile::~ListFile() {
  {
    const std::lock_guard lock(m_mutex);
    m_stopping = true;
  }
  m_wake.notify_one();
  m_thread.join();
  ::unlink(m_path.c_str());
}

void ListFile::setText(std::string text) {
  {
    const std::lock_guard lock(m_mutex);
    if (m_text == text) return;
    m_text = std::move(text);
    m_has_text = true;
  }
  m_wake.notify_one();
}

std::string ListFile::takeNews() {
  const std::lock_guard lock(m_mutex);
  return std::exchange(m_news, std::string());
}

void ListFile::run() {
  std::unique_lock lock(m_mutex);
  while (!m_stopping) {
    m_wake.wait(lock, [this] { return m_stopping || m_has_text; });
    if (m_stopping) return;
    m_has_text = false;
    const std::string text = m_text;
    lock.unlock();
    const std::string problem = writeProblem(m_path, text);
    lock.lock();
    noteResult(problem);
    if (problem.empty()) continue;
    m_has_text = true;
    m_wake.wait_for(lock, kAgain, [this] { return m_stopping; });
  }
}

// A full disk is said once, and once more when it is over.
void ListFile::noteResult(const std::string& problem) {
  const bool failing = !problem.empty();
  if (std::exchange(m_failing, failing) == failing) return;
  m_news = failing ? "warning: the list " + m_path + " cannot be written: " + problem
                   : "the list " + m_path + " is written again";
}

}  // namespace naiad
