#include "engine/testing/TestedModule.h"

#include <dlfcn.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <stdexcept>

namespace df {

namespace fs = std::filesystem;

namespace {

/// A copy that no other process uses, to be removed once it is loaded.
fs::path copyOf(const fs::path& module) {
  std::string name = (fs::temp_directory_path() / (module.stem().string() + "-XXXXXX.so")).string();
  const int file = mkstemps(name.data(), 3);
  if (file < 0) throw std::runtime_error("There is no room for a copy of the game: " + name);
  close(file);
  fs::copy_file(module, name, fs::copy_options::overwrite_existing);
  return name;
}

void* load(const fs::path& module) {
  static std::set<fs::path> s_loaded;
  if (s_loaded.insert(module).second) return dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);
  const fs::path copy = copyOf(module);
  void* p_handle = dlopen(copy.c_str(), RTLD_NOW | RTLD_LOCAL);
  std::error_code none;
  fs::remove(copy, none);
  return p_handle;
}

}  // namespace

TestedModule::TestedModule(const std::string& path) {
  const fs::path module = fs::absolute(path).lexically_normal();
  if (!fs::exists(module))
    throw std::runtime_error("There is no game " + module.string() + ": build it first.");
  void* p_handle = load(module);
  if (p_handle == nullptr) throw std::runtime_error(std::string("The game cannot be loaded: ") + dlerror());
  m_main = reinterpret_cast<Main>(dlsym(p_handle, "main"));
  if (m_main == nullptr) throw std::runtime_error("The game " + module.string() + " has no main().");
  m_name = module.stem().string();
  const fs::path folder = module.parent_path();
  m_folders = {(folder / m_name).string(), folder.string(), folder.parent_path().string()};
}

int TestedModule::main() const {
  std::string name = m_name;
  char* arguments[] = {name.data(), nullptr};
  return m_main(1, arguments);
}

}  // namespace df
