// Preloaded. After refuse_thread(n), the calling thread cannot create its n-th thread from then on. 0: it can
// create all. Returns how many were left until the refused one.
#include <dlfcn.h>
#include <pthread.h>

#include <cerrno>
#include <utility>

namespace
{

thread_local int left = 0;

}  // namespace

extern "C"
{
    int refuse_thread(int number)
    {
        return std::exchange(left, number);
    }

    int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *),
                       void *argument) noexcept
    {
        static const auto real =
            reinterpret_cast<decltype(&pthread_create)>(dlsym(RTLD_NEXT, "pthread_create"));
        if (left > 0 && --left == 0)
        {
            return EAGAIN;
        }
        return real(thread, attributes, start, argument);
    }
}
