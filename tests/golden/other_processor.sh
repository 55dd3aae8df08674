# Sourced: runs programs as on an older x86-64 processor, as far as the C library is concerned, which chooses its functions by the processor.
# shellcheck shell=bash
other_tunables=glibc.cpu.hwcaps=-AVX512F,-AVX2,-FMA,-AVX,-FMA4

on_other_processor() { GLIBC_TUNABLES=$other_tunables "$@"; }

# Says if the C library takes the setting: where it doesn't, or the processor has nothing to leave alone, both runs are the same one.
describe_other_processor() {
  local loader=/lib64/ld-linux-x86-64.so.2 here there
  [[ -x $loader ]] || { echo "No $loader: nothing to choose by the processor is known here."; return; }
  here=$("$loader" --list-diagnostics | grep active || true)
  there=$(on_other_processor "$loader" --list-diagnostics | grep active || true)
  if [[ $here == "$there" ]]; then
    echo "This C library, or this processor, knows nothing that $other_tunables switches off: both runs are the same one."
  else
    echo "Compared: this processor, and $other_tunables"
  fi
}
