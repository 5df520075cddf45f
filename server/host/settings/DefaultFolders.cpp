#include "host/settings/DefaultFolders.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "shared/net/base/SafeFile.h"

namespace naiad {

namespace {

namespace fs = std::filesystem;

/// Sets the default journal, except with --in-process, which has none, and for private worlds: they are not
/// recovered after a crash, so their rounds are recorded only on request.
void useDefaultJournal(HostOptions& options) {
  if (options.journal == kOffWord) return options.journal.clear();
  const bool has_none = options.in_process || options.players == "private";
  if (has_none || !options.journal.empty() || options.state.empty()) return;
  options.journal = options.state + "/rounds";
  options.default_journal = true;
}

/// Creates the folder (0700). Returns an error if it fails or if files cannot be created there.
std::error_code makeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder.parent_path(), error);
  if (error) return error;
  const bool good = (mkdir(folder.c_str(), 0700) == 0 || errno == EEXIST) &&
                    access((folder / ".").c_str(), R_OK | W_OK | X_OK) == 0;
  return good ? std::error_code() : std::error_code(errno, std::generic_category());
}

}  // namespace

void useDefaultFolders(HostOptions& options) {
  options.control_by_port = options.control.empty();
  if (options.control == kOffWord) options.control.clear();
  const auto folder = userDirectory("XDG_STATE_HOME", ".local/state");
  if (options.state.empty() && folder) options.state = folder->string();
  useDefaultJournal(options);
}

void defaultToLoopback(HostOptions& options) {
  if (options.insecure && options.address == HostOptions().address) options.address = "127.0.0.1";
}

HostOptions withUsableJournal(HostOptions options, const LogLine& log) {
  if (!options.default_journal || !usesJournal(options)) return options;
  const std::error_code error = makeFolder(options.journal);
  if (!error) return options;
  log(LogEvent::warning("not recording rounds, so none survives a server crash: " + options.journal + ": " +
                        error.message()));
  options.journal.clear();
  return options;
}

}  // namespace naiad
