/* The program of Python 3.11 for Windows, as small as can be: calls the library beside it. Made by scripts/python-for-windows.
   Usage: that of python */
#include <stdio.h>
#include <windows.h>

int wmain(int count, wchar_t **words) {
    HMODULE python = LoadLibraryW(L"python311.dll");
    int (*run)(int, wchar_t **) = python ? (int (*)(int, wchar_t **))GetProcAddress(python, "Py_Main") : NULL;
    if (!run) {
        fprintf(stderr, "python311.dll cannot be loaded: error %lu\n", GetLastError());
        return 1;
    }
    return run(count, words);
}
