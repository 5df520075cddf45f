#include "host/world/Determinism.h"

#include <dlfcn.h>
#include <link.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "shared/values/FastHash.h"

namespace naiad {

namespace {

namespace fs = std::filesystem;

constexpr const char* kLibrary = "dragonfly/libdragonfly-repeat.so";  // relative to libdragonfly.so's folder
constexpr std::uintmax_t kMaxHashed = std::uintmax_t{64} << 20;

/// Returns the folder that this code's library was loaded from.
fs::path ownFolder() {
  Dl_info facts{};
  std::error_code error;
  if (dladdr(reinterpret_cast<const void*>(&determinismPreload), &facts) == 0 || facts.dli_fname == nullptr)
    return {};
  return fs::weakly_canonical(facts.dli_fname, error).parent_path();
}

std::string sanitizerRuntime() {
  std::string found;
  dl_iterate_phdr(
      [](dl_phdr_info* p_info, std::size_t /*size*/, void* p_found) {
        const std::string_view name = p_info->dlpi_name != nullptr ? p_info->dlpi_name : "";
        for (const char* p_runtime : {"/libasan.so", "/libtsan.so"}) {
          if (name.find(p_runtime) != std::string_view::npos) *static_cast<std::string*>(p_found) = name;
        }
        return 0;
      },
      &found);
  return found;
}

std::uint64_t hashFile(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error) || fs::file_size(path, error) > kMaxHashed || error) return 0;
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  FastHash hash;
  hash.bytes(bytes);
  return file.bad() ? 0 : hash.value();
}

std::string shortName(const std::string& path) {
  const fs::path whole(path);
  const fs::path folder = whole.parent_path().filename();
  const std::string name = (folder / whole.filename()).string();
  return name.size() > kMaxReadFileName ? name.substr(name.size() - kMaxReadFileName) : name;
}

template <class Function>
Function* findInLibrary(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

}  // namespace

std::string determinismPreload() {
  const fs::path library = ownFolder() / kLibrary;
  std::error_code error;
  if (!fs::is_regular_file(library, error)) return {};
  const std::string first = sanitizerRuntime();
  return first.empty() ? library.string() : first + ":" + library.string();
}

std::string determinismEntry(const WorldStartOptions& order) {
  std::ostringstream entry;
  entry << "NAIAD_REPEAT=" << order.seed << ' ' << order.start_nanos << ' ' << order.frame_nanos << ' '
        << (order.again ? 1 : 0);
  return entry.str();
}

void setDeterminismTick(std::uint32_t tick) {
  static auto* const p_set = findInLibrary<void(std::uint32_t)>("naiad_repeat_tick");
  if (p_set != nullptr) p_set(tick);
}

std::vector<ReadFile> popReadFiles() {
  std::vector<ReadFile> files;
  static auto* const p_take = findInLibrary<const char*()>("naiad_repeat_files");
  if (p_take == nullptr) return files;
  std::istringstream paths(p_take());
  for (std::string path; std::getline(paths, path) && files.size() < kMaxReadFiles;)
    files.push_back({shortName(path), hashFile(path)});
  return files;
}

}  // namespace naiad
