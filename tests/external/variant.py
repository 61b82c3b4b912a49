"""Mitsuba, set to compile for the CPU: `from variant import dr, mi`.

Dr.Jit needs LLVM 17 or newer at run time (older ones abort on "Cannot select: fminimum"). DRJIT_LIBLLVM_PATH names the
library; where it is unset, the newest one of the usual folders is taken.
"""

import glob
import os
import re


def newest_llvm():
    """Path of the newest libLLVM, or None."""
    found = []
    for folder in ('/usr/lib/*/', '/usr/lib64/', '/usr/lib/llvm-*/lib/', '/opt/homebrew/opt/llvm*/lib/'):
        for path in glob.glob(folder + 'libLLVM*.so*') + glob.glob(folder + 'libLLVM*.dylib'):
            number = re.search(r'(\d+)', os.path.basename(os.path.realpath(path)))
            if number and int(number[1]) >= 17:
                found.append((int(number[1]), path))
    return max(found)[1] if found else None


if 'DRJIT_LIBLLVM_PATH' not in os.environ and newest_llvm():
    os.environ['DRJIT_LIBLLVM_PATH'] = newest_llvm()

import drjit as dr  # noqa: E402  (reads the variable above)
import mitsuba as mi  # noqa: E402

mi.set_variant('llvm_ad_rgb')

__all__ = ['dr', 'mi']
