// Finds and loads games: shared objects with an ordinary main().
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace naiad {

/// Thrown if a game does not exist or its module cannot be loaded. what() is a message for the user.
class GameError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A loaded game. It stays loaded until the process ends, because static destructors may still run its code.
class GameModule {
 public:
  /// `game`: the name of a shipped game, or a path (anything with a slash). Throws GameError.
  explicit GameModule(const std::string& game);

  // Functions that do not load the module, which would run its static constructors.

  /// Returns the module's absolute path. Throws GameError if there is no shipped game of this name.
  static std::filesystem::path find(const std::string& game);
  /// Returns the file's name without folder and extension, like "saucershoot".
  static std::string nameOf(const std::filesystem::path& module) { return module.stem().string(); }
  static std::vector<std::string> resourceFolders(const std::filesystem::path& module);

  const std::string& name() const { return m_name; }
  /// Returns the folders of the game's files (sprites, sounds): NAME/ next to the module NAME.so, the
  /// module's own folder, and its parent, because many games are built in a subfolder.
  std::vector<std::string> resourceFolders() const { return resourceFolders(m_path); }
  /// Runs the game's main() on this thread and returns its result.
  int main() const;

  /// Returns the names of all games that were found, sorted.
  static std::vector<std::string> available();

 private:
  using Main = int (*)(int, char**);
  std::string m_name;
  std::filesystem::path m_path;  // absolute
  Main m_main = nullptr;
};

}  // namespace naiad
