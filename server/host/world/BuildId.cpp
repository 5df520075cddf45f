#include "host/world/BuildId.h"

#include <elf.h>
#include <link.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <functional>
#include <utility>

#include "shared/net/base/SafeText.h"

namespace naiad {

namespace {

constexpr std::size_t kNoteAlignment = 4;
constexpr char kHere = 0;  ///< a variable in the loaded file that contains this code

std::size_t aligned(std::size_t size) {
  return (size + kNoteAlignment - 1) / kNoteAlignment * kNoteAlignment;
}

/// Returns the build id among the notes at `p`; empty if it is not there.
std::string idAmongNotes(const unsigned char* p, std::size_t size) {
  constexpr char kOwner[] = "GNU";
  while (size >= sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) note;
    std::memcpy(&note, p, sizeof note);
    const std::size_t data = sizeof note + aligned(note.n_namesz);
    const std::size_t whole = data + aligned(note.n_descsz);
    if (whole > size) return {};
    const bool is_gnu =
        note.n_namesz == sizeof kOwner && std::memcmp(p + sizeof note, kOwner, sizeof kOwner) == 0;
    if (is_gnu && note.n_type == NT_GNU_BUILD_ID)
      return hexText({p + data, std::min<std::size_t>(note.n_descsz, kMaxBuildId / 2)});
    p += whole;
    size -= whole;
  }
  return {};
}

std::string idOf(const dl_phdr_info& info) {
  for (int i = 0; i < info.dlpi_phnum; ++i) {
    const ElfW(Phdr)& part = info.dlpi_phdr[i];
    // Other notes, like the processor's properties, have another alignment.
    if (part.p_type != PT_NOTE || part.p_align != kNoteAlignment) continue;
    const auto* p_notes = reinterpret_cast<const unsigned char*>(info.dlpi_addr + part.p_vaddr);
    if (std::string id = idAmongNotes(p_notes, part.p_memsz); !id.empty()) return id;
  }
  return {};
}

bool holds(const dl_phdr_info& info, const void* p_address) {
  const auto address = reinterpret_cast<std::uintptr_t>(p_address);
  return std::any_of(info.dlpi_phdr, info.dlpi_phdr + info.dlpi_phnum, [&](const ElfW(Phdr) & part) {
    const std::uintptr_t begin = info.dlpi_addr + part.p_vaddr;
    return part.p_type == PT_LOAD && address >= begin && address - begin < part.p_memsz;
  });
}

struct Search {
  std::function<bool(const dl_phdr_info& info)> is_wanted;
  std::string id = {};
};

std::string findId(std::function<bool(const dl_phdr_info& info)> is_wanted) {
  Search search{std::move(is_wanted)};
  dl_iterate_phdr(
      [](dl_phdr_info* p_info, std::size_t /*size*/, void* p) {
        auto& in = *static_cast<Search*>(p);
        if (!in.is_wanted(*p_info)) return 0;
        in.id = idOf(*p_info);
        return 1;
      },
      &search);
  return search.id;
}

}  // namespace

std::string buildIdOf(const std::string& file) {
  return findId([&file](const dl_phdr_info& info) {
    const std::filesystem::path path = info.dlpi_name != nullptr ? info.dlpi_name : "";
    return path.filename().string().starts_with(file);
  });
}

const std::string& ownBuildId() {
  static const std::string id = findId([](const dl_phdr_info& info) { return holds(info, &kHere); });
  return id;
}

}  // namespace naiad
