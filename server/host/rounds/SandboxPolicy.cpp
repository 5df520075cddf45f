#include "host/rounds/SandboxPolicy.h"

#include <link.h>
#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "host/auth/ServerIdentity.h"
#include "host/world/Determinism.h"
#include "host/world/WorldStart.h"
#include "shared/net/base/SafeFile.h"

namespace naiad {

namespace {

namespace fs = std::filesystem;

/// Folders of all users or many programs, too wide for a game.
const char* const kWideFolders[] = {"/",    "/dev",  "/etc",  "/home",    "/media",  "/mnt",
                                    "/opt", "/proc", "/root", "/run",     "/srv",    "/sys",
                                    "/tmp", "/usr",  "/var",  "/var/lib", "/var/tmp"};

/// Folders that a game may read even if the folder that contains them also has other things.
const char* const kGameFolders[] = {"sprites", "sounds"};

const char* const kVariables[] = {
    // Variables of the machine.
    "PATH", "HOME", "USER", "LOGNAME", "LANG", "LANGUAGE", "TZ", "TERM", "TMPDIR", "LD_LIBRARY_PATH",
    "ASAN_OPTIONS", "LSAN_OPTIONS", "TSAN_OPTIONS", "UBSAN_OPTIONS",
    // Variables of the engine, for a game that is a program itself.
    "DF_COMPAT", "DRAGONFLY_CONFIG", "NAIAD_ON_GAME_OVER", "NAIAD_INPUT_MODE", "NAIAD_PLAYERS", "NAIAD_SEED"};

/// Variables among kVariables that differ between users and terminals.
const char* const kPersonal[] = {"PATH", "HOME", "USER", "LOGNAME", "LANG", "LANGUAGE", "TERM", "TMPDIR"};

/// Returns an absolute path without links, as far as the path exists.
fs::path resolve(const fs::path& path) {
  std::error_code error;
  const fs::path whole = fs::path(firstDirectory()) / path;
  const fs::path resolved = fs::weakly_canonical(whole, error);
  return error ? whole.lexically_normal() : resolved;
}

/// True if `inner` is in `outer`, or equal to it. Both must be resolved.
bool holds(const fs::path& outer, const fs::path& inner) {
  const auto [rest, _] = std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end());
  return rest == outer.end();
}

fs::path commonFolder(const fs::path& one, const fs::path& other) {
  fs::path common;
  for (auto a = one.begin(), b = other.begin(); a != one.end() && b != other.end() && *a == *b; ++a, ++b)
    common /= *a;
  return common;
}

std::vector<fs::path> homes() {
  std::vector<fs::path> found;
  if (const char* p_home = std::getenv("HOME"); p_home != nullptr && *p_home == '/')
    found.push_back(resolve(p_home));
  if (const passwd* p_user = getpwuid(getuid()); p_user != nullptr && p_user->pw_dir != nullptr)
    found.push_back(resolve(p_user->pw_dir));
  return found;
}

fs::path executable() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error);
}

/// Returns this program and its loaded libraries, including those in folders of the system.
std::vector<fs::path> loadedFiles() {
  std::vector<fs::path> files{executable()};
  dl_iterate_phdr(
      [](dl_phdr_info* p_info, std::size_t /*size*/, void* p_files) {
        if (p_info->dlpi_name != nullptr && *p_info->dlpi_name == '/')
          static_cast<std::vector<fs::path>*>(p_files)->push_back(resolve(p_info->dlpi_name));
        return 0;
      },
      &files);
  return files;
}

std::vector<std::string> preloaded() {
  std::vector<std::string> files;
  std::istringstream all(determinismPreload());
  for (std::string file; std::getline(all, file, ':');) files.push_back(file);
  return files;
}

class Builder {
 public:
  Builder(const HostOptions& options, const GamePaths& place) : m_options(options), m_place(place) {
    for (const std::string& path : {options.identity, options.certificate, options.key}) addSecret(path);
    for (const std::string& path : place.secrets) addSecret(path);
    if (const auto directory = userDirectory("XDG_CONFIG_HOME", ".config")) addSecret(directory->string());
  }

  SandboxPolicy build() {
    m_made.sandbox.on = m_options.sandbox == "on";
    m_made.sandbox.memory = static_cast<std::uint64_t>(m_options.world_memory) << 20;
    for (const fs::path& file : m_loaded) addReadable(file);
    for (const std::string& file : preloaded()) addReadable(resolve(file));
    for (const std::string& file : m_place.files) addReadable(resolve(file));
    for (const std::string& folder : m_place.folders) addFolder(resolve(folder));
    addWorkingDirectory(resolve("."));
    for (const std::string& log : m_place.logs) {
      if (!log.empty()) m_made.sandbox.appendable.push_back(resolve(log).string());
    }
    return std::move(m_made);
  }

 private:
  void addSecret(const std::string& path) {
    if (!path.empty()) m_secrets.push_back(resolve(path));
  }
  void addReadable(const fs::path& path) { m_made.sandbox.readable.push_back(path.string()); }

  bool isWide(const fs::path& folder) const {
    const bool known = std::any_of(std::begin(kWideFolders), std::end(kWideFolders),
                                   [&](auto wide) { return folder == wide; });
    return known || std::any_of(m_homes.begin(), m_homes.end(),
                                [&](const fs::path& home) { return holds(folder, home); });
  }

  /// Returns why a world must not have this folder; empty if it may.
  std::string reservedIn(const fs::path& folder) const {
    if (isWide(folder)) return "is a system or home folder";
    for (const fs::path& secret : m_secrets) {
      if (holds(folder, secret)) return "holds " + secret.string();
      if (holds(secret, folder)) return "belongs to the server";
    }
    return {};
  }

  void addFolder(const fs::path& folder) {
    std::error_code error;
    if (!fs::is_directory(folder, error)) return;
    if (!reservedIn(folder).empty()) return addGameFolders(folder);
    addReadable(folder);
    addLinked(folder);
  }

  void addGameFolders(const fs::path& folder) {
    for (const char* name : kGameFolders) {
      const fs::path inner = folder / name;
      std::error_code error;
      if (!fs::is_symlink(inner, error) && fs::is_directory(inner, error) && reservedIn(inner).empty())
        addReadable(inner);
    }
  }

  // A build folder links to its sources' folders. A link is followed only if the folder that contains both
  // ends is not wide (like / or the home folder), because a game's link could lead to the user's files.
  void addLinked(const fs::path& folder) {
    for (const char* name : kGameFolders) {
      const fs::path inner = folder / name;
      std::error_code error;
      if (!fs::is_symlink(inner, error)) continue;
      const fs::path target = resolve(inner);
      if (!isWide(commonFolder(folder, target)) && reservedIn(target).empty()) addReadable(target);
    }
  }

  void addWorkingDirectory(const fs::path& folder) {
    const std::string reserved = reservedIn(folder);
    if (!reserved.empty()) {
      addGameFolders(folder);
      return note(folder, "use", reserved);
    }
    addLinked(folder);
    const auto own = std::find_if(m_loaded.begin(), m_loaded.end(),
                                  [&](const fs::path& file) { return holds(folder, file); });
    if (m_place.is_program || own == m_loaded.end()) {
      m_made.sandbox.writable.push_back(folder.string());
      noteServerFiles(folder);
    } else {
      addReadable(folder);
      note(folder, "write to", "holds " + own->string());
    }
  }

  // Warns of server files in the folder, because Landlock allows folders only as a whole.
  void noteServerFiles(const fs::path& folder) {
    for (const std::string& file : m_place.server_files) {
      if (file.empty() || !holds(folder, resolve(file))) continue;
      m_made.notes.push_back("warning: game processes can change " + resolve(file).string() +
                             ", which is in the folder that they write to");
    }
  }

  void note(const fs::path& folder, const std::string& what, const std::string& why) {
    m_made.notes.push_back("game processes cannot " + what + " the working directory " + folder.string() +
                           ", which " + why);
  }

  const HostOptions& m_options;
  const GamePaths& m_place;
  const std::vector<fs::path> m_homes = homes();
  const std::vector<fs::path> m_loaded = loadedFiles();
  std::vector<fs::path> m_secrets;
  SandboxPolicy m_made;
};

bool isListed(std::string_view name, std::string_view list) {
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(','), list.size());
    if (list.substr(0, end) == name) return true;
    list.remove_prefix(std::min(end + 1, list.size()));
  }
  return false;
}

constexpr std::string_view kPasswords[] = {"--password", "--admin-password"};

}  // namespace

SandboxPolicy makeSandboxPolicy(const HostOptions& options, const GamePaths& place) {
  return Builder(options, place).build();
}

std::vector<std::string> makeWorldEnvironment(const HostOptions& options) {
  std::vector<std::string> entries;
  for (char** p = environ; *p != nullptr; ++p) {
    const std::string_view entry(*p);
    const std::string_view name = entry.substr(0, entry.find('='));
    const bool known = std::any_of(std::begin(kVariables), std::end(kVariables),
                                   [name](const char* p_known) { return name == p_known; });
    const bool wanted = known || name.starts_with("LC_") || isListed(name, options.world_environment);
    if (wanted && name != "NAIAD_PASSWORD" && name != "NAIAD_ADMIN_PASSWORD") entries.emplace_back(entry);
  }
  return entries;
}

bool isGameVariable(const std::string& entry) {
  return entry.starts_with("DF_COMPAT=") || entry.starts_with("TZ=");
}

std::vector<std::string> makeFixedEnvironment(const HostOptions& options) {
  std::vector<std::string> entries = makeWorldEnvironment(options);
  std::erase_if(entries, [&options](const std::string& entry) {
    const std::string_view name = std::string_view(entry).substr(0, entry.find('='));
    const bool personal = std::any_of(std::begin(kPersonal), std::end(kPersonal),
                                      [name](const char* p_one) { return name == p_one; });
    return (personal || name.starts_with("LC_")) && !isListed(name, options.world_environment);
  });
  entries.insert(entries.end(), {"PATH=/usr/local/bin:/usr/bin:/bin", "LANG=C.UTF-8"});
  return entries;
}

void hidePassword(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view word(argv[i]);
    char* p_value = nullptr;
    for (const std::string_view option : kPasswords) {
      if (word == option && i + 1 < argc) p_value = argv[i + 1];
      if (word.starts_with(option) && word.substr(option.size()).starts_with('='))
        p_value = argv[i] + option.size() + 1;
    }
    if (p_value != nullptr) std::memset(p_value, '*', std::strlen(p_value));
  }
}

std::vector<std::string> withoutPasswords(const std::vector<std::string>& words) {
  std::vector<std::string> left;
  bool is_value = false;
  for (const std::string& word : words) {
    const bool follows = std::exchange(is_value, false);
    const std::string name = word.substr(0, word.find('='));
    const bool is_one = std::find(std::begin(kPasswords), std::end(kPasswords), name) != std::end(kPasswords);
    is_value = is_one && name == word;
    if (!follows && !is_one) left.push_back(word);
  }
  return left;
}

std::string configFileOf(int argc, const char* const* argv) {
  constexpr std::string_view kConfig = "--config";
  for (int i = 1; i < argc; ++i) {
    const std::string_view word(argv[i]);
    if (word == kConfig && i + 1 < argc) return argv[i + 1];
    if (word.starts_with("--config=")) return std::string(word.substr(kConfig.size() + 1));
  }
  return {};
}

}  // namespace naiad
