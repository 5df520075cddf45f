#include "server/directory/Directory.h"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "shared/net/stream/JoinLink.h"

namespace naiad {
namespace {

constexpr std::chrono::milliseconds kMaxPollInterval{250};

/// Returns the time between updates: at most a quarter of the heartbeat interval, to notice changes soon.
std::chrono::milliseconds pollInterval(const DirectorySettings& settings) {
  return std::min(kMaxPollInterval, settings.interval / 4);
}

BusSettings listening(BusSettings settings) {
  settings.subjects = {presenceSubject("*")};
  return settings;
}

ServerIdentity identityOf(const DirectorySettings& settings) {
  if (!settings.certificate.empty()) return ServerIdentity::load(settings.certificate, settings.key);
  const std::filesystem::path folder = settings.identity.empty() ? ServerIdentity::defaultDirectory()
                                                                 : std::filesystem::path(settings.identity);
  return ServerIdentity::loadOrMake(folder, std::chrono::system_clock::now());
}

}  // namespace

Directory::Directory(DirectorySettings settings, LogLine log)
    : m_settings(std::move(settings)),
      m_log(std::move(log)),
      m_fleet(
          connectBus(listening(m_settings.bus)), [this](const std::string& text) { m_log(text); },
          m_settings.interval) {
  if (!m_settings.list.empty()) m_file.emplace("list", m_settings.list, serverListText({}));
  openLobby();
  schedulePoll();
}

void Directory::openLobby() {
  if (!m_settings.lobby) return;
  m_identity = identityOf(m_settings);
  m_lobby.emplace(m_context, *m_settings.lobby, m_identity->tls(), m_fleet.servers());
}

// Reopens the log and reloads the lobby's key. If the key cannot be read, keeps the old one.
void Directory::reload() {
  LineLog::reopenAll();
  if (!m_lobby) return;
  try {
    ServerIdentity read = identityOf(m_settings);
    if (read.fingerprint() != m_identity->fingerprint())
      m_log("the lobby's key has changed: existing links to the lobby no longer work");
    m_identity = std::move(read);
    m_lobby->setTls(m_identity->tls());
  } catch (const TlsError& error) {
    m_log({LogEvent::Level::kWarning,
           std::string("warning: the lobby keeps its old certificate: ") + error.what()});
  }
}

void Directory::schedulePoll() {
  m_timer.expires_after(pollInterval(m_settings));
  m_timer.async_wait([this](const std::error_code& error) {
    if (error) return;
    poll(std::chrono::steady_clock::now());
    schedulePoll();
  });
}

void Directory::poll(Time now) {
  m_fleet.update(now);
  publishRedirects(now);
  if (!m_file) return;
  m_file->setText(serverListText(m_fleet.servers().servers()));
  if (const std::string line = m_file->popLogMessage(); !line.empty()) m_log(line);
}

/// Once per heartbeat interval, tells servers that are nearly full or closed where they can redirect players.
void Directory::publishRedirects(Time now) {
  if (now - m_published_at < m_settings.interval) return;
  m_published_at = now;
  for (const Presence& full : m_fleet.servers().nearlyFull()) {
    const FleetRegistry::Assignment other =
        m_fleet.servers().leastLoaded({full.game, full.protocol, full.id});
    if (!other) continue;
    const auto link = JoinLink::parse(linkOf(*other.p_server, other.room));
    const auto* const p_link = std::get_if<JoinLink>(&link);
    if (p_link == nullptr) continue;
    const std::string payload = Redirect{other.p_server->id, *p_link}.payload();
    for (const std::string& subject : {redirectSubject(full.id), formerRedirectSubject(full.id)})
      m_fleet.bus().publish({subject, payload});
  }
}

void Directory::installSignalHandlers() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) m_signals.add(signal);
  m_signals.async_wait([this](const std::error_code& error, int signal) {
    if (error) return;
    if (signal != SIGHUP) return stop();
    reload();
    installSignalHandlers();
  });
}

void Directory::stop() {
  m_signals.clear();
  m_timer.cancel();
  m_context.stop();
}

void Directory::logCounters() {
  const FleetCounters& counted = m_fleet.servers().counters();
  const BusCounters passed = m_fleet.bus().counters();
  std::vector<std::pair<const char*, std::uint64_t>> all = {{"heartbeats", counted.heartbeats},
                                                            {"unreadable", counted.unreadable},
                                                            {"wrong_subject", counted.wrong_subject},
                                                            {"over_limit", counted.over_limit},
                                                            {"expired", counted.expired},
                                                            {"bus_received", passed.received},
                                                            {"bus_ignored", passed.ignored},
                                                            {"bus_lost", passed.lost},
                                                            {"bus_failures", passed.failures},
                                                            {"bus_connections", passed.connections}};
  if (m_lobby) {
    const LobbyCounters& met = m_lobby->counters();
    const TcpListener::Counters& streams = m_lobby->streams();
    all.insert(all.end(), {{"hellos", met.hellos},
                           {"redirected", met.redirected},
                           {"no_slot", met.no_slot},
                           {"no_game", met.no_game},
                           {"malformed", met.malformed},
                           {"timeouts", met.timeouts},
                           {"pending_evicted", met.pending_evicted},
                           {"handshakes", streams.handshakes},
                           {"handshakes_failed", streams.handshakes_failed},
                           {"handshakes_late", streams.handshakes_late},
                           {"refused_too_often", streams.refused_too_often}});
  }
  std::string line = "counters:";
  for (const auto& [name, count] : all) {
    if (count > 0) line += std::string(" ") + name + "=" + std::to_string(count);
  }
  m_log(line);
}

Directory::~Directory() = default;

void Directory::run() {
  m_context.run();
  logCounters();
}

std::optional<std::uint16_t> Directory::port() const {
  return m_lobby ? std::optional(m_lobby->port()) : std::nullopt;
}

std::optional<Fingerprint> Directory::fingerprint() const {
  return m_identity ? std::optional(m_identity->fingerprint()) : std::nullopt;
}

}  // namespace naiad
