// Finds and loads games: shared objects with an ordinary main().
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace naiad {

/// No such game, or its module cannot be loaded. what() is a sentence for the person at the command line.
class GameError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A loaded game. It stays loaded until the process ends: its code may be on the stack of static destructors.
class GameModule {
 public:
  /// `game`: the name of a shipped game, or a path (anything with a slash). Throws GameError.
  explicit GameModule(const std::string& game);

  // Without loading it, which would run its static constructors:

  /// The module's absolute path. Throws GameError if a shipped game of this name is not there.
  static std::filesystem::path find(const std::string& game);
  /// "saucershoot": the file's name without folder and ending.
  static std::string nameOf(const std::filesystem::path& module) { return module.stem().string(); }
  static std::vector<std::string> resourceFolders(const std::filesystem::path& module);

  const std::string& name() const { return m_name; }
  /// Where its files are (sprites, sounds): a folder of the module's name beside it, the one it is in itself,
  /// and the one above, for many build in a folder of their own.
  std::vector<std::string> resourceFolders() const { return resourceFolders(m_path); }
  /// Run the game's main() on this thread; what it returns.
  int main() const;

  /// The names of all games that can be named, sorted.
  static std::vector<std::string> available();

 private:
  using Main = int (*)(int, char**);
  std::string m_name;
  std::filesystem::path m_path;  // absolute
  Main m_main = nullptr;
};

}  // namespace naiad
