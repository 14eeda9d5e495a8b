// PNG files, written whole or not at all.
#ifndef APP_COMMAND_PNG_H
#define APP_COMMAND_PNG_H

#include <stdbool.h>
#include <stdint.h>

// channels: 4 (rgba; alpha is left out) or 1 (gray). False where the file could not be written; errno says why.
bool png_write(const char *path, uint32_t width, uint32_t height, int channels, const uint8_t *pixels);

#endif
