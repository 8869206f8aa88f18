#include "core/allocation_count.hpp"

#include <cstdlib>
#include <new>

namespace {

// Counting must not itself need the heap or a lock, hence at namespace scope.
thread_local std::size_t g_count = 0;

/// Null without memory.
void* counted(std::size_t size, std::size_t alignment) noexcept {
  ++g_count;
  const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
  return std::aligned_alloc(alignment, rounded > 0 ? rounded : alignment);
}

void* or_throw(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) {
  return or_throw(counted(size, alignof(std::max_align_t)));
}
/// std::stable_sort asks so.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return counted(size, alignof(std::max_align_t));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return or_throw(counted(size, static_cast<std::size_t>(alignment)));
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace hopscotch::core {

std::size_t allocation_count() {
  return g_count;
}

}  // namespace hopscotch::core
