// SHA-256 (FIPS 180-4) of a whole buffer.
#ifndef STUDIES_PROTOCOL_SHA256_H
#define STUDIES_PROTOCOL_SHA256_H

#include <stddef.h>
#include <stdint.h>

enum { SHA256_BYTES = 32, SHA256_HEX = 65 };

void sha256(const void *data, size_t size, uint8_t out[SHA256_BYTES]);
void sha256_hex(const uint8_t digest[SHA256_BYTES], char out[SHA256_HEX]); // lower case, terminated

#endif
