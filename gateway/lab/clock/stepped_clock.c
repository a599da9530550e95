/* A wall clock that a test sets forward and back while a program runs, by LD_PRELOAD. STEPPED_CLOCK names a
 * file of one 64-bit integer: seconds that are added to CLOCK_REALTIME. The monotonic clock stays as it is.
 *
 * A step moves the end of absolute waits on the wall clock that are under way: they are cut into slices of 50
 * ms, each of which ends as if woken for no reason. A caller of pthread_mutex_timedlock waits for the whole
 * time. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

/* No monotonic clock since boot is that large, and no wall clock since 2001 is smaller. */
#define LEAST_WALL_CLOCK 1000000000

#define SLICE_NS 50000000

static const volatile int64_t *offset;

static int64_t step(void)
{
    return offset ? *offset : 0;
}

__attribute__((constructor)) static void open_offset(void)
{
    const char *path = getenv("STEPPED_CLOCK");
    const int file = path ? open(path, O_RDONLY | O_CLOEXEC) : -1;
    if (file < 0)
    {
        return;
    }
    void *mapped = mmap(NULL, sizeof *offset, PROT_READ, MAP_SHARED, file, 0);
    close(file);
    if (mapped != MAP_FAILED)
    {
        offset = mapped;
    }
}

int clock_gettime(clockid_t clock, struct timespec *now)
{
    const int result = (int)syscall(SYS_clock_gettime, clock, now);
    if (result == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE))
    {
        now->tv_sec += step();
    }
    return result;
}

int gettimeofday(struct timeval *restrict now, void *restrict zone)
{
    (void)zone;
    struct timespec exact;
    clock_gettime(CLOCK_REALTIME, &exact);
    now->tv_sec = exact.tv_sec;
    now->tv_usec = exact.tv_nsec / 1000;
    return 0;
}

time_t time(time_t *seconds)
{
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    if (seconds)
    {
        *seconds = now.tv_sec;
    }
    return now.tv_sec;
}

static struct timespec unstepped(const struct timespec *until)
{
    struct timespec real = *until;
    if (real.tv_sec > LEAST_WALL_CLOCK)
    {
        real.tv_sec -= step();
    }
    return real;
}

/* The end of a wait, or of a slice of it. Returns whether it is the end of the wait. */
static int slice(clockid_t clock, const struct timespec *until, struct timespec *end)
{
    *end = *until;
    if (until->tv_sec <= LEAST_WALL_CLOCK)
    {
        return 1;
    }
    struct timespec sliced;
    syscall(SYS_clock_gettime, clock, &sliced);
    sliced.tv_nsec += SLICE_NS;
    sliced.tv_sec += sliced.tv_nsec / 1000000000;
    sliced.tv_nsec %= 1000000000;
    *end = unstepped(until);
    if (end->tv_sec < sliced.tv_sec || (end->tv_sec == sliced.tv_sec && end->tv_nsec <= sliced.tv_nsec))
    {
        return 1;
    }
    *end = sliced;
    return 0;
}

/* The result of a wait, from that of a slice. */
static int result_of(int result, int isEnd)
{
    return result == ETIMEDOUT && !isEnd ? 0 : result;
}

int pthread_cond_timedwait(pthread_cond_t *restrict condition, pthread_mutex_t *restrict mutex,
                           const struct timespec *restrict until)
{
    static int (*next)(pthread_cond_t *, pthread_mutex_t *, const struct timespec *);
    if (!next)
    {
        /* x86-64 has an older version of the same name, which dlsym may find. */
        *(void **)&next = dlvsym(RTLD_NEXT, "pthread_cond_timedwait", "GLIBC_2.3.2");
    }
    if (!next)
    {
        *(void **)&next = dlsym(RTLD_NEXT, "pthread_cond_timedwait");
    }
    struct timespec end;
    const int isEnd = slice(CLOCK_REALTIME, until, &end);
    return result_of(next(condition, mutex, &end), isEnd);
}

int pthread_cond_clockwait(pthread_cond_t *condition, pthread_mutex_t *mutex, clockid_t clock,
                           const struct timespec *until)
{
    static int (*next)(pthread_cond_t *, pthread_mutex_t *, clockid_t, const struct timespec *);
    if (!next)
    {
        *(void **)&next = dlsym(RTLD_NEXT, "pthread_cond_clockwait");
    }
    struct timespec end;
    const int isEnd = slice(clock, until, &end);
    return result_of(next(condition, mutex, clock, &end), isEnd);
}

int pthread_mutex_timedlock(pthread_mutex_t *restrict mutex, const struct timespec *restrict until)
{
    static int (*next)(pthread_mutex_t *, const struct timespec *);
    if (!next)
    {
        *(void **)&next = dlsym(RTLD_NEXT, "pthread_mutex_timedlock");
    }
    const struct timespec real = unstepped(until);
    return next(mutex, &real);
}
