// Preloaded into the services by bench budget: the kernel's filter of the bus is not attached, so that its gain can be
// measured on any build.
#include <dlfcn.h>
#include <sys/socket.h>

extern "C" int setsockopt(int fd, int level, int name, const void* value, socklen_t size) {
  if (level == SOL_SOCKET && name == SO_ATTACH_FILTER) return 0;
  using SetSockOpt = int (*)(int, int, int, const void*, socklen_t);
  static const auto next = reinterpret_cast<SetSockOpt>(dlsym(RTLD_NEXT, "setsockopt"));
  return next(fd, level, name, value, size);
}
