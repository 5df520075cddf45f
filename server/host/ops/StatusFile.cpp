#include "host/ops/StatusFile.h"

#include <unistd.h>

#include <stdexcept>
#include <system_error>
#include <utility>

#include "shared/json/Json.h"
#include "shared/net/base/SafeFile.h"
#include "shared/values/Version.h"

namespace naiad {

std::string statusText(const ServerInfo& facts, const std::string& link) {
  Json status = jsonOf(facts);
  status.set("version", kVersion);
  if (!link.empty()) status.set("link", link);
  return status.toString(Json::Style::kAscii) + "\n";
}

StatusFile::StatusFile(std::string path, ServerInfo facts, std::string link)
    : m_path(std::move(path)), m_link(std::move(link)), m_facts(std::move(facts)) {
  try {
    publishFile(m_path, statusText(m_facts, m_link));
  } catch (const std::system_error& error) {
    throw std::runtime_error("The status file " + m_path + " cannot be written: " + error.what());
  }
  m_thread = std::thread([this] { run(); });
}

StatusFile::~StatusFile() {
  {
    const std::lock_guard lock(m_mutex);
    m_stopping = true;
  }
  m_stop.notify_one();
  m_thread.join();
  ::unlink(m_path.c_str());
}

void StatusFile::setPlayers(std::uint32_t players) {
  const std::lock_guard lock(m_mutex);
  m_facts.players = players;
}

std::string StatusFile::popLogMessage() {
  const std::lock_guard lock(m_mutex);
  return std::exchange(m_log_message, std::string());
}

void StatusFile::run() {
  std::unique_lock lock(m_mutex);
  while (!m_stop.wait_for(lock, kInterval, [this] { return m_stopping; })) {
    const ServerInfo facts = m_facts;
    lock.unlock();
    write(facts);
    lock.lock();
  }
}

// Reports a failure (such as a full disk) once, and once more when writing works again.
void StatusFile::write(const ServerInfo& facts) {
  std::string problem;
  try {
    publishFile(m_path, statusText(facts, m_link));
  } catch (const std::system_error& error) {
    problem = error.what();
  }
  const std::lock_guard lock(m_mutex);
  const bool failing = !problem.empty();
  if (failing == m_failing) return;
  m_failing = failing;
  m_log_message = failing ? "warning: the status file " + m_path + " cannot be written: " + problem
                          : "the status file " + m_path + " can be written again";
}

}  // namespace naiad
