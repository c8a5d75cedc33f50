#!/bin/sh
# Installs the system libraries that the workstation needs: with apt when root, otherwise it prints the one line
# to paste and goes on, since a desktop often has them under other names.
list=$(dirname "$0")/debian-packages.txt
command -v dpkg-query >/dev/null 2>&1 || exit 0
missing=""
while read -r package; do
    status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null)
    # Debian's transition to 64-bit time renamed some libraries: libasound2 became libasound2t64
    renamed=$(dpkg-query -W -f='${Status}' "${package}t64" 2>/dev/null)
    case "$status$renamed" in
        *"install ok installed"*) ;;
        *) missing="$missing $package" ;;
    esac
done <"$list"
[ -z "$missing" ] && exit 0
if [ "$(id -u)" = 0 ]; then
    echo "Installing system libraries:$missing"
    export DEBIAN_FRONTEND=noninteractive
    apt-get update -qq >/dev/null && apt-get install -y -qq --no-install-recommends $missing >/dev/null
else
    echo "Some system libraries are missing. Paste this line, then start again:"
    echo "  sudo apt-get install -y --no-install-recommends$missing"
fi
