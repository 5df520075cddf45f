#include "host/settings/GameModule.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>

namespace naiad {

namespace fs = std::filesystem;

namespace {

/// Returns the folders to search for games: NAIAD_GAMES, then those of the build tree and of an installation.
std::vector<fs::path> folders() {
  std::vector<fs::path> all;
  if (const char* named = std::getenv("NAIAD_GAMES")) all.emplace_back(named);
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  all.push_back(program / "../lib/games");
  for (const char* lib : {"../lib/dragonfly/games", "../lib64/dragonfly/games"}) all.push_back(program / lib);
#ifdef NAIAD_LIBDIR
  all.push_back(program / ".." / NAIAD_LIBDIR / "dragonfly/games");
#endif
  return all;
}

fs::path locate(const std::string& game) {
  if (game.find('/') != std::string::npos) return game;
  for (const fs::path& folder : folders()) {
    fs::path candidate = folder / (game + ".so");
    if (fs::exists(candidate)) return candidate;
  }
  std::string known;
  for (const std::string& name : GameModule::available()) known += (known.empty() ? "" : ", ") + name;
  throw GameError("There is no game \"" + game + "\". " +
                  (known.empty() ? "No games were found; NAIAD_GAMES can name their folder."
                                 : "Available games: " + known + "."));
}

}  // namespace

GameModule::GameModule(const std::string& game) : m_path(find(game)) {
  m_name = nameOf(m_path);
  void* handle = dlopen(m_path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) throw GameError("The game cannot be loaded: " + std::string(dlerror()));
  m_main = reinterpret_cast<Main>(dlsym(handle, "main"));
  if (m_main == nullptr) throw GameError("The game " + m_path.string() + " has no main().");
}

fs::path GameModule::find(const std::string& game) {
  return fs::absolute(locate(game)).lexically_normal();
}

std::vector<std::string> GameModule::resourceFolders(const fs::path& module) {
  const fs::path folder = module.parent_path();
  return {(folder / nameOf(module)).string(), folder.string(), folder.parent_path().string()};
}

int GameModule::main() const {
  std::string name = m_name;
  char* arguments[] = {name.data(), nullptr};
  return m_main(1, arguments);
}

std::vector<std::string> GameModule::available() {
  std::vector<std::string> names;
  for (const fs::path& folder : folders()) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      if (entry.path().extension() == ".so") names.push_back(entry.path().stem().string());
    }
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

}  // namespace naiad
