// Preloaded: after hold_creator, the calling thread stops behind each thread that it creates, until go_on is
// called, or for half a second: the threads of a transport never call it.
#include <dlfcn.h>
#include <pthread.h>
#include <semaphore.h>

#include <atomic>
#include <ctime>

namespace
{

sem_t goesOn;
std::atomic<bool> holds{false};
pthread_t creator;

void WaitForHalfASecond()
{
    timespec limit{};
    clock_gettime(CLOCK_MONOTONIC, &limit);
    limit.tv_nsec += 500000000;
    limit.tv_sec += limit.tv_nsec / 1000000000;
    limit.tv_nsec %= 1000000000;
    sem_clockwait(&goesOn, CLOCK_MONOTONIC, &limit);
}

}  // namespace

extern "C"
{
    void hold_creator()
    {
        sem_init(&goesOn, 0, 0);
        creator = pthread_self();
        holds = true;
    }

    void go_on()
    {
        holds = false;
        sem_post(&goesOn);
    }

    int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *),
                       void *argument) noexcept
    {
        static const auto real =
            reinterpret_cast<decltype(&pthread_create)>(dlsym(RTLD_NEXT, "pthread_create"));
        const int failed = real(thread, attributes, start, argument);
        if (holds && pthread_equal(creator, pthread_self()) != 0)
        {
            WaitForHalfASecond();
        }
        return failed;
    }
}
