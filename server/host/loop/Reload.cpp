#include "host/loop/Reload.h"

#include <exception>
#include <utility>

namespace naiad {

namespace {

Reloaded readAgain(const Reload::ReadOptions& read, const HostOptions& now) {
  Reloaded reloaded;
  try {
    reloaded.options = read();
    const HostOptions& next = reloaded.options;
    if (!next.password.empty() && next.password != now.password)
      reloaded.password = PasswordHash::fromText(next.password);
    if (!now.certificate.empty() && !next.certificate.empty())
      reloaded.identity = ServerIdentity::load(next.certificate, next.key);
  } catch (const std::exception& error) {
    reloaded.problem = error.what();
  }
  return reloaded;
}

}  // namespace

Reload::~Reload() {
  if (m_thread.joinable()) m_thread.join();
}

bool Reload::begin(const HostOptions& now, std::function<void(Reloaded)> done) {
  if (m_reading.exchange(true)) return false;
  if (m_thread.joinable()) m_thread.join();
  m_thread = std::thread([this, now, done = std::move(done)] {
    done(readAgain(m_read, now));
    m_reading = false;
  });
  return true;
}

}  // namespace naiad
