/* Shared libraries, on POSIX and on Windows. */
#ifndef LOADING_H
#define LOADING_H

#include <stdio.h>
#include <stdlib.h>

#ifdef _WIN32
#include <windows.h>
static void *load(const char *path) {
    void *library = (void *)LoadLibraryA(path);
    if (!library) fprintf(stderr, "cannot load %s: error %lu\n", path, GetLastError());
    return library;
}
static void *find(void *library, const char *name) { return (void *)GetProcAddress((HMODULE)library, name); }
#else
#include <dlfcn.h>
static void *load(const char *path) {
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!library) fprintf(stderr, "%s\n", dlerror());
    return library;
}
static void *find(void *library, const char *name) { return dlsym(library, name); }
#endif

static void *need(void *library, const char *name) {
    void *symbol = library ? find(library, name) : 0;
    if (!symbol) {
        fprintf(stderr, "no %s\n", name);
        exit(1);
    }
    return symbol;
}

#endif
