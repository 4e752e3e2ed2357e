/* Random bytes as Windows 10 gives them, for wine before version 9, which lacks this library.
 *
 * Only ever beside the test program: Windows has the real one, and the FMU never ships this.
 */
#include <windows.h>

BOOLEAN NTAPI SystemFunction036(PVOID buffer, ULONG size);

__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE data, SIZE_T size) {
    return SystemFunction036(data, (ULONG)size);
}
