#include "shared/program/BuildId.h"

#include <link.h>

namespace naiad {

namespace {

struct Search {
  std::string_view name;
  std::string found;
};

std::string digitsOf(const unsigned char* p, std::size_t count) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    text.push_back(kDigits[p[i] >> 4]);
    text.push_back(kDigits[p[i] & 15]);
  }
  return text;
}

/// Of the notes in one segment of a loaded file.
std::string idInNotes(const unsigned char* p, const unsigned char* p_end) {
  while (p + sizeof(ElfW(Nhdr)) <= p_end) {
    const auto* p_note = reinterpret_cast<const ElfW(Nhdr)*>(p);
    const unsigned char* const p_data = p + sizeof *p_note + (p_note->n_namesz + 3) / 4 * 4;
    if (p_note->n_type == NT_GNU_BUILD_ID) return digitsOf(p_data, p_note->n_descsz);
    p = p_data + (p_note->n_descsz + 3) / 4 * 4;
  }
  return {};
}

std::string idOf(const dl_phdr_info& info) {
  for (int i = 0; i < info.dlpi_phnum; ++i) {
    const ElfW(Phdr)& header = info.dlpi_phdr[i];
    if (header.p_type != PT_NOTE) continue;
    const auto* p = reinterpret_cast<const unsigned char*>(info.dlpi_addr + header.p_vaddr);
    if (std::string id = idInNotes(p, p + header.p_memsz); !id.empty()) return id;
  }
  return {};
}

bool isNamed(const dl_phdr_info& info, std::string_view name) {
  const std::string_view path = info.dlpi_name != nullptr ? info.dlpi_name : "";
  if (name.empty()) return path.empty();  // the program has no name here
  return path.substr(path.rfind('/') + 1).starts_with(name);
}

}  // namespace

std::string buildIdOf(std::string_view name) {
  Search search{name, {}};
  dl_iterate_phdr(
      [](dl_phdr_info* p_info, std::size_t /*size*/, void* p_search) {
        auto& wanted = *static_cast<Search*>(p_search);
        if (!isNamed(*p_info, wanted.name)) return 0;
        wanted.found = idOf(*p_info);
        return 1;
      },
      &search);
  return search.found;
}

}  // namespace naiad
