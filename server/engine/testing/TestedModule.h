// A game's module, loaded for one test.
#pragma once

#include <string>
#include <vector>

namespace df {

class TestedModule {
 public:
  /// Load it: the first time in this process from where it is, later from a copy in the folder for temporary
  /// files, for what is loaded twice from one file is the same, with the variables of the game before. Throws
  /// std::runtime_error.
  explicit TestedModule(const std::string& path);

  /// Run the game's main(). It stays loaded: destructors of its static Objects may still run.
  int main() const;
  /// Where its sprites and sounds are looked for: beside it in a folder of its name, in its folder, and above
  /// that.
  const std::vector<std::string>& folders() const { return m_folders; }

 private:
  using Main = int (*)(int, char**);
  std::string m_name;
  std::vector<std::string> m_folders;
  Main m_main = nullptr;
};

}  // namespace df
