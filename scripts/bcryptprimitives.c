/* The one function of Windows' bcryptprimitives.dll that Rust's standard library calls, for a wine that has no such
   library (wine 8 has none). For the smoke test only; no part of a package. */
#include <windows.h>

BOOLEAN NTAPI SystemFunction036(void *bytes, ULONG size);

__declspec(dllexport) BOOL WINAPI ProcessPrng(BYTE *bytes, SIZE_T size) {
    return SystemFunction036(bytes, (ULONG)size);
}
