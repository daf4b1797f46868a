/* What programs share that replay a run: its files, and calls that must succeed. */
#ifndef REPLAYED_H
#define REPLAYED_H

#include "palpate.h"
#include <stdio.h>
#include <stdlib.h>

static void *contents(const char *path, size_t *bytes)
{
    FILE *from = fopen(path, "rb");
    if (!from) exit(2);
    void *memory = aligned_alloc(8, 1 << 22);
    *bytes = fread(memory, 1, 1 << 22, from);
    fclose(from);
    return memory;
}

static void good(palpate_status status)
{
    if (status == PALPATE_OK) return;
    printf("refused: %s\n", palpate_status_text(status));
    exit(1);
}

#endif
