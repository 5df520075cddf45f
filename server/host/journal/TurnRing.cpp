#include "host/journal/TurnRing.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <new>
#include <system_error>

#include "shared/net/base/SafeFile.h"
#include "shared/net/base/SafeText.h"
#include "shared/values/FastHash.h"

namespace naiad {

namespace {

constexpr char kRingMagic[9] = "NAIADRG3";
constexpr std::uint64_t kMaxRing = std::uint64_t{64} << 20;

constexpr const char* kRings = "/dev/shm";
constexpr std::string_view kRingName = "naiad-";

std::string ringPath(const std::array<std::uint8_t, 16>& uuid) {
  return std::string(kRings) + "/" + std::string(kRingName) + uuidText(uuid);
}

std::string readAll(int file) {
  std::string bytes;
  struct stat facts {};
  if (fstat(file, &facts) != 0) return bytes;
  bytes.resize(std::min(static_cast<std::uint64_t>(facts.st_size), kMaxRing));
  std::size_t at = 0;
  for (ssize_t got = 1; at < bytes.size() && got > 0;
       at += static_cast<std::size_t>(std::max<ssize_t>(got, 0)))
    got = pread(file, bytes.data() + at, bytes.size() - at, static_cast<off_t>(at));
  bytes.resize(at);
  return bytes;
}

/// Returns a descriptor; -1 if the ring is missing or not trusted.
int openRing(const std::string& path) {
  try {
    return openTrusted(path, O_RDONLY);
  } catch (const std::system_error&) {
    return -1;
  }
}

}  // namespace

std::string uuidText(const std::array<std::uint8_t, 16>& uuid) {
  return hexText(uuid);
}

TurnRing::TurnRing(std::size_t capacity, const std::array<std::uint8_t, 16>& uuid, bool shared,
                   std::uint64_t position, std::uint64_t folder, const FilePrologue& beginning)
    : m_capacity(capacity),
      m_prologue_size(beginning.name.empty() ? 0 : beginning.name.size() + 1 + beginning.bytes.size()) {
  if (!shared || !mapShared(uuid)) {
    void* p_memory = mmap(nullptr, size(), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (p_memory == MAP_FAILED)
      throw std::system_error(errno, std::generic_category(), "cannot allocate the journal's memory");
    m_p_head = new (p_memory) Head{};
  }
  std::copy(uuid.begin(), uuid.end(), m_p_head->uuid);
  m_p_head->folder = folder;
  m_p_head->capacity = m_capacity;
  m_p_head->stored = position;
  m_p_head->released = position;
  m_p_head->beginning = m_prologue_size;
  if (m_prologue_size > 0) {
    char* p_end = std::copy(beginning.name.begin(), beginning.name.end(), bytes() + m_capacity);
    *p_end++ = '\0';
    std::copy(beginning.bytes.begin(), beginning.bytes.end(), p_end);
  }
  std::atomic_signal_fence(std::memory_order_release);  // written last: a ring without it is ignored
  std::memcpy(m_p_head->magic, kRingMagic, sizeof m_p_head->magic);
}

TurnRing::~TurnRing() {
  munmap(m_p_head, size());
  if (!m_path.empty() && !m_handed_over) unlink(m_path.c_str());
  if (m_file >= 0) close(m_file);
}

// Allocates the whole file at once, because a write into a hole raises SIGBUS if the file system is full.
bool TurnRing::mapShared(const std::array<std::uint8_t, 16>& uuid) {
  const std::string path = ringPath(uuid);
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (file < 0) return false;
  void* p_memory = MAP_FAILED;
  if (posix_fallocate(file, 0, static_cast<off_t>(size())) == 0)
    p_memory = mmap(nullptr, size(), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (p_memory == MAP_FAILED || flock(file, LOCK_EX | LOCK_NB) != 0) {
    if (p_memory != MAP_FAILED) munmap(p_memory, size());
    unlink(path.c_str());
    close(file);
    return false;
  }
  m_file = file;
  m_p_head = new (p_memory) Head{};
  m_path = path;
  return true;
}

bool TurnRing::store(std::string_view data) {
  const std::uint64_t stored = m_p_head->stored.load(std::memory_order_relaxed);
  const std::uint64_t used = stored - m_p_head->released.load(std::memory_order_acquire);
  if (data.size() > m_capacity - used) return false;
  const auto at = static_cast<std::size_t>(stored % m_capacity);
  const std::size_t first = std::min(data.size(), m_capacity - at);
  std::memcpy(bytes() + at, data.data(), first);
  std::memcpy(bytes(), data.data() + first, data.size() - first);
  m_p_head->stored.store(stored + data.size(), std::memory_order_release);
  return true;
}

bool TurnRing::isFilling() const {
  const std::uint64_t stored = m_p_head->stored.load(std::memory_order_relaxed);
  return stored - m_p_head->released.load(std::memory_order_relaxed) > m_capacity / 2;
}

std::size_t TurnRing::peek(std::string& out, std::size_t most) const {
  const std::uint64_t released = m_p_head->released.load(std::memory_order_relaxed);
  const std::uint64_t stored = m_p_head->stored.load(std::memory_order_acquire);
  const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(stored - released, most));
  const auto at = static_cast<std::size_t>(released % m_capacity);
  const std::size_t first = std::min(count, m_capacity - at);
  out.append(bytes() + at, first);
  out.append(bytes(), count - first);
  return count;
}

std::optional<OrphanedRing> OrphanedRing::find(const std::array<std::uint8_t, 16>& uuid) {
  return open(ringPath(uuid));
}

std::optional<OrphanedRing> OrphanedRing::open(std::string path) {
  OrphanedRing ring;
  ring.m_path = std::move(path);
  const int file = openRing(ring.m_path);
  if (file < 0) return std::nullopt;
  if (flock(file, LOCK_EX | LOCK_NB) == 0) ring.m_bytes = readAll(file);
  close(file);
  TurnRing::Head head{};
  if (ring.m_bytes.size() < sizeof head) return std::nullopt;
  std::memcpy(static_cast<void*>(&head), ring.m_bytes.data(), sizeof head);
  const bool good = std::memcmp(head.magic, kRingMagic, sizeof head.magic) == 0 && head.capacity > 0 &&
                    head.beginning <= ring.m_bytes.size() - sizeof head &&
                    head.capacity == ring.m_bytes.size() - sizeof head - head.beginning &&
                    head.released.load() <= head.stored.load() &&
                    head.stored.load() - head.released.load() <= head.capacity;
  return good ? std::optional(std::move(ring)) : std::nullopt;
}

std::optional<FilePrologue> OrphanedRing::beginning() const {
  TurnRing::Head head{};
  std::memcpy(static_cast<void*>(&head), m_bytes.data(), sizeof head);
  if (head.released.load() != 0 || head.stored.load() == 0) return std::nullopt;
  const std::string_view text =
      std::string_view(m_bytes).substr(sizeof head + static_cast<std::size_t>(head.capacity));
  const std::size_t zero = text.find('\0');
  if (zero == std::string_view::npos) return std::nullopt;
  return FilePrologue{std::string(text.substr(0, zero)), std::string(text.substr(zero + 1))};
}

std::optional<std::string> OrphanedRing::bytesFrom(std::uint64_t position) const {
  TurnRing::Head head{};
  std::memcpy(static_cast<void*>(&head), m_bytes.data(), sizeof head);
  const std::uint64_t stored = head.stored.load();
  if (position > stored || stored - position > head.capacity) return std::nullopt;
  const std::string_view ring =
      std::string_view(m_bytes).substr(sizeof head, static_cast<std::size_t>(head.capacity));
  const auto count = static_cast<std::size_t>(stored - position);
  const auto at = static_cast<std::size_t>(position % head.capacity);
  const std::size_t first = std::min(count, ring.size() - at);
  return std::string(ring.substr(at, first)).append(ring.substr(0, count - first));
}

std::uint64_t ringFolder(const std::string& folder) {
  FastHash hash;
  hash.bytes(folder);
  return hash.value() | 1;  // never 0, which means an unknown folder
}

namespace {

/// Returns the paths of all rings except those of these rounds.
std::vector<std::string> ringsWithout(const std::set<std::string>& rounds) {
  std::vector<std::string> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(kRings, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(kRingName) && !rounds.contains(name.substr(kRingName.size())))
      paths.push_back(entry.path().string());
  }
  return paths;
}

}  // namespace

// A ring that is being created has no lock and no magic yet; it must not be locked here.
bool TurnRing::isRingOf(int file, std::uint64_t folder) {
  alignas(Head) char bytes[sizeof(Head)];
  const auto* p_head = reinterpret_cast<const Head*>(bytes);
  return pread(file, bytes, sizeof bytes, 0) == sizeof bytes &&
         std::memcmp(p_head->magic, kRingMagic, sizeof p_head->magic) == 0 && p_head->folder == folder;
}

std::vector<OrphanedRing> OrphanedRing::findWithoutFile(std::uint64_t folder,
                                                        const std::set<std::string>& known) {
  std::vector<OrphanedRing> found;
  for (const std::string& path : ringsWithout(known)) {
    const int file = openRing(path);
    const bool is_of_folder = file >= 0 && TurnRing::isRingOf(file, folder);
    if (file >= 0) close(file);
    if (!is_of_folder) continue;
    if (auto ring = open(path); ring && ring->beginning()) found.push_back(*std::move(ring));
  }
  return found;
}

std::size_t removeStrayRings(std::uint64_t folder, const std::set<std::string>& kept) {
  std::size_t removed = 0;
  for (const std::string& path : ringsWithout(kept)) {
    const int file = openRing(path);
    if (file < 0) continue;
    const bool stray = TurnRing::isRingOf(file, folder) && flock(file, LOCK_EX | LOCK_NB) == 0;
    if (stray && unlink(path.c_str()) == 0) ++removed;
    close(file);
  }
  return removed;
}

void OrphanedRing::remove() const {
  unlink(m_path.c_str());
}

void TurnRing::release(std::size_t count) {
  m_p_head->released.fetch_add(count, std::memory_order_release);
}

}  // namespace naiad
