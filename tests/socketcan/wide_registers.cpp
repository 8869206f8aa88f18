// Loaded before user-mode Linux: lets it run on processors whose register state is larger than its
// own (AMX tiles). It hands back the front part that it knows, and the host's kernel takes the
// whole or nothing; then what is missing is filled up with what the process has.
#include <elf.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace {

/// User-mode Linux has one processor and small stacks.
alignas(64) std::array<std::byte, 65536> whole;

long set_front(std::uintptr_t process, const iovec& front) {
  iovec all{.iov_base = whole.data(), .iov_len = whole.size()};
  constexpr long kSet = NT_X86_XSTATE;
  if (syscall(SYS_ptrace, PTRACE_GETREGSET, process, kSet, &all) != 0) return -1;
  if (front.iov_len > all.iov_len) {
    errno = EFAULT;
    return -1;
  }
  std::memcpy(whole.data(), front.iov_base, front.iov_len);
  return syscall(SYS_ptrace, PTRACE_SETREGSET, process, kSet, &all);
}

}  // namespace

// The C library's prototype.
extern "C" long ptrace(enum __ptrace_request request, ...) noexcept {
  std::va_list arguments;
  va_start(arguments, request);
  const auto process = va_arg(arguments, std::uintptr_t);
  const auto address = va_arg(arguments, std::uintptr_t);
  const auto data = va_arg(arguments, std::uintptr_t);
  va_end(arguments);
  const bool peeks = request >= PTRACE_PEEKTEXT && request <= PTRACE_PEEKUSER;
  if (peeks) {  // the library's calling convention differs from the kernel's
    long word = 0;
    const long result = syscall(SYS_ptrace, request, process, address, &word);
    return result < 0 ? result : word;
  }
  const long result = syscall(SYS_ptrace, request, process, address, data);
  if (result == 0 || request != PTRACE_SETREGSET || address != NT_X86_XSTATE) return result;
  return set_front(process, *reinterpret_cast<const iovec*>(data));
}
