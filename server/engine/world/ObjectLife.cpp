// The part of Object that begins and ends it: memory, constructor, destructor.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <new>

#include "engine/world/DelayedFree.h"
#include "engine/world/Object.h"
#include "engine/world/ObjectExtras.h"
#include "engine/world/World.h"
#include "engine/world/WorldStore.h"

namespace df {

namespace {

// Blocks that operator new has handed out and in which no Object has been constructed yet. The constructor
// finds itself in one of them, or was not made with `new`. More than one at a time: `new A(new B)`.
struct PendingBlocks {
  struct Block {
    const std::byte* begin;
    std::size_t size;
  };
  std::array<Block, 64> blocks;
  std::size_t count = 0;

  void push(const void* p, std::size_t size) {
    if (count < blocks.size()) blocks[count++] = {static_cast<const std::byte*>(p), size};
  }
  bool erase(std::size_t i) {
    for (--count; i < count; ++i) blocks[i] = blocks[i + 1];
    return true;
  }
  bool claim(const void* p) {
    const auto* address = static_cast<const std::byte*>(p);
    for (std::size_t i = count; i-- > 0;) {
      if (address >= blocks[i].begin && address < blocks[i].begin + blocks[i].size) return erase(i);
    }
    return false;
  }
  void cancel(const void* p) {  // the constructor threw before it got to Object
    for (std::size_t i = count; i-- > 0;) {
      if (blocks[i].begin == p) erase(i);
    }
  }
};

thread_local PendingBlocks t_pending;

// The function that eventHandler() of this Object is, to find out whether its class has one of its own. By
// the Itanium C++ ABI, which GCC and Clang follow: an Object begins with the address of its vtable, and on
// x86-64 a pointer to a virtual member function begins with 1 + the function's offset there. Null where that
// does not hold.
const void* handlerOf(const Object& object) {
#if defined(__x86_64__) && defined(__GXX_ABI_VERSION)
  int (Object::*const p_member)(const Event*) = &Object::eventHandler;
  std::ptrdiff_t offset = 0;
  std::memcpy(&offset, &p_member, sizeof offset);
  const std::byte* p_table = nullptr;
  std::memcpy(&p_table, static_cast<const void*>(&object), sizeof p_table);
  const void* p_function = nullptr;
  std::memcpy(&p_function, p_table + offset - 1, sizeof p_function);
  return p_function;
#else
  (void)object;
  return nullptr;
#endif
}

const void* g_p_base_handler = nullptr;

// An Object begins with a cache line: what every event needs is in it.
constexpr std::align_val_t kLine{64};

// What an Object without a sprite collides with in the published engine: characters one apart do not touch.
const FixedBox kCompatBox{{-kFixedOne / 2, -kFixedOne / 2}, {*toFixed(0.99), *toFixed(0.99)}};
const FixedVector kCompatPlace{kFixedOne, kFixedOne};

// Games of the published engine live on memory that happens to be zero there.
void* cleared(void* p, std::size_t size) {
  return World::current().compat() ? std::memset(p, 0, size) : p;
}

}  // namespace

void* Object::operator new(std::size_t size) {
  void* p = cleared(::operator new(size, kLine), size);
  t_pending.push(p, size);
  return p;
}

void* Object::operator new(std::size_t size, const std::nothrow_t& nothrow) noexcept {
  void* p = ::operator new(size, kLine, nothrow);
  if (p != nullptr) t_pending.push(cleared(p, size), size);
  return p;
}

void* Object::operator new(std::size_t size, std::align_val_t align) {
  void* p = cleared(::operator new(size, align), size);
  t_pending.push(p, size);
  return p;
}

void Object::operator delete(void* p) noexcept {
  operator delete(p, kLine);
}

void Object::operator delete(void* p, std::align_val_t align) noexcept {
  t_pending.cancel(p);
  if (!World::current().compat()) {
    ::operator delete(p, align);
    return;
  }
  // Never destroyed: static Objects may delete others when the thread's own have gone.
  thread_local auto* t_p_freed = new (std::nothrow) DelayedFree;
  if (t_p_freed != nullptr) {
    t_p_freed->free(p, align);
  } else {
    ::operator delete(p, align);
  }
}

Object::Object() : m_p_store(nullptr), m_slot(0), m_p_profile(nullptr) {
  World& world = World::current();
  m_p_store = &world.store();
  m_slot = m_p_store->takeSlot(this, t_pending.claim(this));
  m_p_profile = &m_p_store->profile(m_slot);
  if (world.compat()) {
    m_p_store->setBox(m_slot, kCompatBox);
    m_p_store->setPosition(m_slot, kCompatPlace);
    m_p_profile->type = kUndefinedType;
  }
  // Here it is still nothing but an Object.
  if (g_p_base_handler == nullptr) g_p_base_handler = handlerOf(*this);
  world.insertObject(this);
}

Object::~Object() {
  if (m_p_extras != nullptr) dropExtras();
  if (World* p_world = getWorld()) p_world->forget(this);
  m_p_store->giveBackSlot(m_slot);
  // Calls on the deleted Object (DelayedFree.h) must find no extras, so the compiler must not drop this
  // store.
  m_p_extras.reset();
  std::atomic_signal_fence(std::memory_order_seq_cst);
}

bool Object::isDeaf() const {
  return g_p_base_handler != nullptr && handlerOf(*this) == g_p_base_handler;
}

}  // namespace df
