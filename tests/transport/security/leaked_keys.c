/* Writes the session keys with which a program encrypts or signs into the file that LEAKED_KEYS names, 32
 * bytes each, by LD_PRELOAD: the keys that somebody has who took over a member. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <openssl/evp.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define KEY_SIZE 32

typedef int (*init)(EVP_CIPHER_CTX *, const EVP_CIPHER *, const unsigned char *, const unsigned char *);
typedef int (*init_ex)(EVP_CIPHER_CTX *, const EVP_CIPHER *, ENGINE *, const unsigned char *,
                       const unsigned char *);

static void leak(const EVP_CIPHER_CTX *context, const unsigned char *key)
{
    const char *file = getenv("LEAKED_KEYS");
    if (key == NULL || file == NULL || EVP_CIPHER_CTX_get_key_length(context) != KEY_SIZE)
    {
        return;
    }
    const int out = open(file, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
    if (out < 0 || write(out, key, KEY_SIZE) != KEY_SIZE)
    {
        abort();
    }
    close(out);
}

/* ISO C has no conversion from a pointer to data, which dlsym returns, to one to a function. */
static void find(void *function, const char *name)
{
    void *const found = dlsym(RTLD_NEXT, name);
    memcpy(function, &found, sizeof found);
}

int EVP_EncryptInit(EVP_CIPHER_CTX *context, const EVP_CIPHER *cipher, const unsigned char *key,
                    const unsigned char *iv)
{
    init next;
    find(&next, "EVP_EncryptInit");
    const int result = next(context, cipher, key, iv);
    leak(context, key);
    return result;
}

int EVP_EncryptInit_ex(EVP_CIPHER_CTX *context, const EVP_CIPHER *cipher, ENGINE *engine,
                       const unsigned char *key, const unsigned char *iv)
{
    init_ex next;
    find(&next, "EVP_EncryptInit_ex");
    const int result = next(context, cipher, engine, key, iv);
    leak(context, key);
    return result;
}
