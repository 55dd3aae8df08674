#!/usr/bin/env bash
# The set-up of tasks/demo and tests/run on a machine whose package system another program holds, as unattended upgrades do after the first start:
# it says so, waits, and goes on. apt-get, dpkg-query and sudo are stand-ins that take real locks on files of $1, an empty directory to work in.
set -euo pipefail
setup=$(cd "$(dirname "$0")/../.." && pwd)/.ci/setup.sh
work=$1
rm -rf "$work"
mkdir -p "$work/bin" "$work/.ci"
cd "$work"
echo 'no-such-package  build' > .ci/packages
touch lists frontend

cat > bin/dpkg-query << 'END'
#!/usr/bin/env bash
exit 1
END
cat > bin/sudo << 'END'
#!/usr/bin/env bash
exec "$@"
END
# What apt-get 2.6 says and how it ends; `update` takes the lock on the lists, `install` that of dpkg.
cat > bin/apt-get << 'END'
#!/usr/bin/env bash
shift # -qq
echo "$1" >> calls
[[ -e interrupted && $1 == install ]] && { echo "E: dpkg was interrupted, you must manually run 'dpkg --configure -a' to correct the problem. "; exit 100; }
[[ -e offline ]] && { echo "E: Failed to fetch http://deb.debian.org/debian/dists/bookworm/InRelease"; exit 100; }
lock=$([[ $1 == update ]] && echo lists || echo frontend)
if ! flock --nonblock "$lock" true; then
  echo "E: Could not get lock /var/lib/$lock. It is held by process 812 (unattended-upgr)"
  exit 100
fi
END
chmod +x bin/*
export PATH=$work/bin:$PATH PINCER_APT_LOOK=0.1

# set_up   what tasks/demo does first
set_up() { bash -c "set -euo pipefail; . '$setup'; ensure_packages build; echo built" > out 2>&1; }
# fails WHAT   a check failed: says which, with the output
fails() { echo "failed: $1"; cat out; exit 1; }

# Held for a while: first the lists, then dpkg.
for lock in lists frontend; do
  rm -f calls
  flock "$lock" sleep 1 &
  sleep 0.2
  set_up || fails "$lock held for a second: the set-up ended"
  grep -q "Waiting for another program .*/var/lib/$lock. It is held by process 812 (unattended-upgr)" out || fails "$lock: doesn't say for whom it waits"
  (($(grep -c Waiting out) == 1)) || fails "$lock: says it more than once"
  grep -q "going on" out && grep -q built out || fails "$lock: doesn't go on"
  (($(wc -l < calls) > 4)) || fails "$lock: didn't try again"
  wait
done
# Never given up: an end after the limit, with what to do.
flock lists sleep 3 &
sleep 0.2
if PINCER_APT_WAIT=1 set_up; then fails "a lock that is never given up"; fi
grep -q "gave up waiting" out || fails "a lock that is never given up: doesn't say so"
wait
# What waiting doesn't mend ends at once.
rm calls
touch offline
if set_up; then fails "no network"; fi
grep -q "Failed to fetch" out && grep -q "build/packages.log" out || fails "no network: doesn't say so"
(($(wc -l < calls) == 1)) || fails "no network: tried again"
rm offline
touch interrupted
if set_up; then fails "dpkg was interrupted"; fi
grep -q "dpkg --configure -a" out && grep -q "cut off in its middle" out || fails "dpkg was interrupted: no remedy"
[[ -f build/packages.log && ! -e build-packages.log ]] || fails "the log isn't in the build tree"
echo "ok"
