#include "host/ops/HostCommands.h"

#include <asio/post.hpp>
#include <filesystem>
#include <utility>

#include "host/admin/ControlFile.h"
#include "host/world/Descendants.h"
#include "shared/admin/ControlPath.h"
#include "shared/net/stream/TcpListener.h"

namespace naiad {

HostCommands::HostCommands(Setup setup, asio::io_context& home)
    : m_setup(std::move(setup)),
      m_home(home),
      m_admin(m_setup.host),
      m_console({m_admin, m_setup.worker, m_setup.bans, m_setup.log,
                 [&home](std::function<void()> job) { asio::post(home, std::move(job)); }}),
      m_chat(chatSetup(), home.get_executor()) {}

HostCommands::~HostCommands() {
  close();
}

// Answers of the worker go to the socket's clients.
void HostCommands::close() {
  m_control.reset();
  m_setup.worker.finish();
}

ChatCommands::Setup HostCommands::chatSetup() {
  return {m_setup.host.options,
          m_setup.host.sessions,
          m_admin,
          m_console,
          m_setup.bans,
          [this](const std::string& address, const std::string& text) {
            m_setup.client_log.logNews(address, text, m_setup.host.network.now());
          },
          [this](const std::string& address, const std::string& text) {
            m_setup.client_log.logRefusal(address, text, m_setup.host.network.now());
          }};
}

void HostCommands::listen() {
  const HostOptions& options = m_setup.host.options;
  const bool by_default = options.control.empty() && options.control_by_port;
  ControlListening where = listening(by_default);
  if (where.path.empty()) return;
  const std::string path = where.path.string();
  try {
    m_control = std::make_unique<ControlSocket>(std::move(where), executor(), m_setup.feed, m_setup.log);
    m_path = path;
  } catch (const ListenError& error) {
    if (!by_default) throw;
    m_setup.log({LogEvent::Level::kWarning,
                 std::string("warning: ") + error.what() + " dfctl cannot reach this server (--control)."});
  }
}

// A world must not give orders, nor hide in a namespace from where its process has no number here.
ControlListening HostCommands::listening(bool by_default) const {
  ControlListening listening;
  listening.path = m_setup.host.options.control;
  if (by_default) {
    listening.path = controlPath(m_setup.host.network.port()).value_or(std::filesystem::path());
    removeStaleControls(listening.path.parent_path());
  }
  listening.is_refused = [](pid_t process) { return process <= 0 || isDescendant(process); };
  return listening;
}

ControlSocket::Execute HostCommands::executor() {
  return [this](AdminRequest request, AdminCaller caller, AdminConsole::Done done) {
    asio::post(m_home, [this, request = std::move(request), caller = std::move(caller),
                        done = std::move(done)] { m_console.execute(request, caller, done); });
  };
}

}  // namespace naiad
