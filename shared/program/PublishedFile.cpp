#include "shared/program/PublishedFile.h"

#include <unistd.h>

#include <stdexcept>
#include <system_error>
#include <utility>

#include "shared/net/base/SafeFile.h"

namespace naiad {

PublishedFile::PublishedFile(const std::string& what, std::string path, std::string text)
    : m_path(std::move(path)), m_name(what + " " + m_path), m_text(std::move(text)) {
  if (const std::string problem = write(m_text); !problem.empty())
    throw std::runtime_error("The " + m_name + " cannot be written: " + problem);
}

PublishedFile::~PublishedFile() {
  m_thread.finish();
  ::unlink(m_path.c_str());
}

void PublishedFile::setText(std::string text, bool always) {
  const std::lock_guard lock(m_mutex);
  if (text == m_text && !always && !m_failing) return;
  m_text = std::move(text);
  if (!std::exchange(m_waits, true)) m_thread.enqueue([this] { writeNext(); });
}

std::string PublishedFile::popLogMessage() {
  const std::lock_guard lock(m_mutex);
  return std::exchange(m_log_message, "");
}

// Returns the error; empty on success.
std::string PublishedFile::write(const std::string& text) const {
  try {
    publishFile(m_path, text);
  } catch (const std::system_error& error) {
    return error.what();
  }
  return "";
}

void PublishedFile::writeNext() {
  std::unique_lock lock(m_mutex);
  m_waits = false;
  const std::string text = m_text;
  lock.unlock();
  const std::string problem = write(text);
  lock.lock();
  const bool failing = !problem.empty();
  if (std::exchange(m_failing, failing) == failing) return;
  m_log_message = failing ? "warning: the " + m_name + " cannot be written: " + problem
                          : "the " + m_name + " can be written again";
}

}  // namespace naiad
