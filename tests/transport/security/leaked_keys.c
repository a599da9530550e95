/* Writes the session keys with which a program encrypts, signs, decrypts and verifies into the file that
 * LEAKED_KEYS names, by LD_PRELOAD: a thief who took over a member has these keys. Each record is `e` or `d`
 * (encrypts or decrypts), and 32 bytes. */
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

static void leak(const EVP_CIPHER_CTX *context, char use, const unsigned char *key)
{
    const char *file = getenv("LEAKED_KEYS");
    if (key == NULL || file == NULL || EVP_CIPHER_CTX_get_key_length(context) != KEY_SIZE)
    {
        return;
    }
    unsigned char record[1 + KEY_SIZE];
    record[0] = (unsigned char)use;
    memcpy(record + 1, key, KEY_SIZE);
    const int out = open(file, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
    if (out < 0 || write(out, record, sizeof record) != sizeof record)
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

#define LEAKING(NAME, USE)                                                                \
    int NAME(EVP_CIPHER_CTX *context, const EVP_CIPHER *cipher, const unsigned char *key, \
             const unsigned char *iv)                                                     \
    {                                                                                     \
        init next;                                                                        \
        find(&next, #NAME);                                                               \
        const int result = next(context, cipher, key, iv);                                \
        leak(context, USE, key);                                                          \
        return result;                                                                    \
    }                                                                                     \
    int NAME##_ex(EVP_CIPHER_CTX *context, const EVP_CIPHER *cipher, ENGINE *engine,      \
                  const unsigned char *key, const unsigned char *iv)                      \
    {                                                                                     \
        init_ex next;                                                                     \
        find(&next, #NAME "_ex");                                                         \
        const int result = next(context, cipher, engine, key, iv);                        \
        leak(context, USE, key);                                                          \
        return result;                                                                    \
    }

LEAKING(EVP_EncryptInit, 'e')
LEAKING(EVP_DecryptInit, 'd')
