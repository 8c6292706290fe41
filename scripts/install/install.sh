#!/bin/sh
# Installs squama @VERSION@ for this user, without administrator rights.
#
#     curl -fsSL @URL@/install.sh | sh
#
# SQUAMA_BIN is the folder of the command, by default ~/.local/bin. SQUAMA_URL is the address of the
# archives.
set -eu

version=@VERSION@
url=${SQUAMA_URL:-@URL@}
bin=${SQUAMA_BIN:-$HOME/.local/bin}
sums='@SUMS@'

fail() {
    printf 'install.sh: %s\n' "$1" >&2
    exit 1
}

case $(uname -s)-$(uname -m) in
Linux-x86_64) target=x86_64-unknown-linux-gnu ;;
Linux-aarch64 | Linux-arm64) target=aarch64-unknown-linux-gnu ;;
Darwin-x86_64) target=x86_64-apple-darwin ;;
Darwin-arm64) target=aarch64-apple-darwin ;;
*) fail "there is no archive for $(uname -s) on $(uname -m); install with: cargo install squama" ;;
esac
name=squama-$version-$target
sum=$(printf '%s\n' "$sums" | awk -v file="$name.tar.gz" '$2 == file { print $1 }')
[ -n "$sum" ] || fail "this release has no archive for $target; install with: cargo install squama"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if command -v curl >/dev/null; then
    curl -fsSL "$url/$name.tar.gz" -o "$work/archive"
elif command -v wget >/dev/null; then
    wget -q "$url/$name.tar.gz" -O "$work/archive"
else
    fail 'curl or wget is required'
fi
if command -v sha256sum >/dev/null; then
    found=$(sha256sum "$work/archive" | cut -d ' ' -f 1)
else
    found=$(shasum -a 256 "$work/archive" | cut -d ' ' -f 1)
fi
[ "$found" = "$sum" ] || fail "$name.tar.gz has another checksum than this release; nothing was installed"
tar -xzf "$work/archive" -C "$work"
mkdir -p "$bin"
# Copy and rename, because a running command cannot be overwritten.
cp "$work/$name/squama" "$bin/.squama.new"
mv "$bin/.squama.new" "$bin/squama"
printf '%s: %s\n' "$bin/squama" "$("$bin/squama" --version)"
case :$PATH: in
*":$bin:"*) ;;
*) printf 'Add %s to PATH.\n' "$bin" ;;
esac
