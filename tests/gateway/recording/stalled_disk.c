/* A disk that stalls, by LD_PRELOAD. STALLED_DISK names a file of one byte: while that is not 0, fdatasync does not
 * return. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

static const volatile char *stalled;

__attribute__((constructor)) static void open_switch(void)
{
    const char *path = getenv("STALLED_DISK");
    const int file = path ? open(path, O_RDONLY | O_CLOEXEC) : -1;
    if (file < 0)
    {
        return;
    }
    void *mapped = mmap(NULL, 1, PROT_READ, MAP_SHARED, file, 0);
    close(file);
    if (mapped != MAP_FAILED)
    {
        stalled = mapped;
    }
}

int fdatasync(int file)
{
    static int (*next)(int);
    if (!next)
    {
        *(void **)&next = dlsym(RTLD_NEXT, "fdatasync");
    }
    while (stalled && *stalled)
    {
        poll(NULL, 0, 10);
    }
    return next(file);
}
