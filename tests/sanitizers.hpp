#pragma once

// KAIROS_SANITIZED_MEMORY: memory comes from the allocator of the address or the thread sanitizer.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define KAIROS_SANITIZED_MEMORY
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define KAIROS_SANITIZED_MEMORY
#endif
#endif
