// RABIT_SANITIZED is defined if a sanitizer is compiled in: it keeps freed memory for a while, takes several
// bytes for each byte in use, and has an allocator of its own.
#pragma once

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)  // GCC
#define RABIT_SANITIZED
#elif defined(__has_feature)  // clang
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define RABIT_SANITIZED
#endif
#endif
