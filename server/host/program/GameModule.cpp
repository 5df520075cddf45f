#include "host/program/GameModule.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>

namespace naiad {

namespace fs = std::filesystem;

namespace {

/// Folders with games: what the environment names, beside the program as built, and as installed.
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
                  (known.empty() ? "No games were found at all; NAIAD_GAMES can name their folder."
                                 : "These can be played: " + known + "."));
}

}  // namespace

GameModule::GameModule(const std::string& game) {
  const fs::path path = locate(game);
  m_name = path.stem().string();
  m_folder = fs::absolute(path).parent_path();
  void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) throw GameError("The game cannot be loaded: " + std::string(dlerror()));
  m_main = reinterpret_cast<Main>(dlsym(handle, "main"));
  if (m_main == nullptr) throw GameError("The game " + path.string() + " has no main().");
}

std::vector<std::string> GameModule::resourceFolders() const {
  return {(m_folder / m_name).string(), m_folder.string(), m_folder.parent_path().string()};
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
