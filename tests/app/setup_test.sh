#!/usr/bin/env bash
# Checks app/setup: apt-get is repeated while another program has its lock, but not after another failure, and a second
# program that needs a build folder waits for the first and says so.
set -euo pipefail
# shellcheck source=app/setup
source "$(dirname "${BASH_SOURCE[0]}")/../../app/setup"
achilles_root=$(mktemp -d)
trap 'rm -rf "$achilles_root"' EXIT
cd "$achilles_root"

fail() { echo "failed: $*" >&2; cat said >&2; exit 1; }
tries() { wc -l <tries; }
sleep() { :; }  # apt_get waits between its tries

# An apt-get that prints $problem and fails until its try number $free.
mkdir tools
cat >tools/apt-get <<'END'
#!/usr/bin/env bash
echo "$*" >>tries
[ "$(wc -l <tries)" -ge "$free" ] || { echo "E: $problem" >&2; exit 100; }
END
printf '#!/usr/bin/env bash\nexec "$@"\n' >tools/sudo
chmod +x tools/apt-get tools/sudo
PATH=$achilles_root/tools:$PATH

export problem="Could not get lock /var/lib/apt/lists/lock. It is held by process 1" free=3
apt_get update 2>said || fail "apt_get gives up while another program has the lock"
[ "$(tries)" -eq 3 ] || fail "there are $(tries) tries instead of 3"
[ "$(grep -c 'waiting for it to end' said)" -eq 1 ] || fail "apt_get does not say once that it waits"

rm tries
problem="Unable to locate package nothing"
status=0
apt_get install nothing 2>said || status=$?
[ "$status" -eq 100 ] || fail "the status of apt-get is lost: $status"
[ "$(tries)" -eq 1 ] || fail "apt_get repeats what fails for another reason"

mkfifo has_lock end
(lock_folder some; echo yes >has_lock; read -r <end) &
read -r <has_lock
(lock_folder some; echo locked >>said) 2>said &
until grep -q 'another build is running in build/some; waiting for it to end' said; do command sleep 0.05; done
! grep -q locked said || fail "two programs have the same folder"
echo now >end
wait
grep -q locked said || fail "the second program does not go on"
echo "app/setup waits for other programs"
