#include "host/journal/TurnRing.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <system_error>

namespace naiad {

namespace {

constexpr char kRingMagic[9] = "NAIADRG1";

}  // namespace

std::string uuidText(const std::array<std::uint8_t, 16>& uuid) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : uuid) {
    text.push_back(kDigits[byte >> 4]);
    text.push_back(kDigits[byte & 15]);
  }
  return text;
}

TurnRing::TurnRing(std::size_t capacity, const std::array<std::uint8_t, 16>& uuid, bool shared)
    : m_capacity(capacity) {
  if (!shared || !mapShared(uuid)) {
    void* p_memory =
        mmap(nullptr, sizeof(Head) + m_capacity, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (p_memory == MAP_FAILED)
      throw std::system_error(errno, std::generic_category(), "the journal's memory");
    m_p_head = new (p_memory) Head{};
  }
  std::memcpy(m_p_head->magic, kRingMagic, sizeof m_p_head->magic);
  std::copy(uuid.begin(), uuid.end(), m_p_head->uuid);
  m_p_head->capacity = m_capacity;
}

TurnRing::~TurnRing() {
  munmap(m_p_head, sizeof(Head) + m_capacity);
  if (!m_path.empty()) unlink(m_path.c_str());
}

// All of it is there from the beginning: to write into a hole of a full file system would be a SIGBUS.
bool TurnRing::mapShared(const std::array<std::uint8_t, 16>& uuid) {
  const std::string path = "/dev/shm/naiad-" + uuidText(uuid);
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (file < 0) return false;
  const auto size = static_cast<off_t>(sizeof(Head) + m_capacity);
  void* p_memory = MAP_FAILED;
  if (posix_fallocate(file, 0, size) == 0)
    p_memory = mmap(nullptr, static_cast<std::size_t>(size), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  close(file);
  if (p_memory == MAP_FAILED) {
    unlink(path.c_str());
    return false;
  }
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

void TurnRing::release(std::size_t count) {
  m_p_head->released.fetch_add(count, std::memory_order_release);
}

}  // namespace naiad
