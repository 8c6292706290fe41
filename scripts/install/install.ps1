# Installs squama @VERSION@ for this user, without administrator rights.
#
#     irm @URL@/install.ps1 | iex
#
# SQUAMA_BIN is the folder of the command, by default %LOCALAPPDATA%\squama. SQUAMA_URL is the address
# of the archives.
$ErrorActionPreference = 'Stop'

$version = '@VERSION@'
$url = if ($env:SQUAMA_URL) { $env:SQUAMA_URL } else { '@URL@' }
$bin = if ($env:SQUAMA_BIN) { $env:SQUAMA_BIN } else { Join-Path $env:LOCALAPPDATA 'squama' }
$sums = @'
@SUMS@
'@

$target = if ($env:PROCESSOR_ARCHITECTURE -eq 'ARM64') { 'aarch64-pc-windows-msvc' } else { 'x86_64-pc-windows-msvc' }
$name = "squama-$version-$target"
$line = $sums -split "`r?`n" | Where-Object { $_ -match "^[0-9a-f]{64}  $([regex]::Escape("$name.zip"))$" }
if (-not $line) { throw "this release has no archive for $target; install with: cargo install squama" }

$work = Join-Path ([IO.Path]::GetTempPath()) ([IO.Path]::GetRandomFileName())
New-Item -ItemType Directory -Path $work | Out-Null
try {
    $archive = Join-Path $work 'archive.zip'
    Invoke-WebRequest -Uri "$url/$name.zip" -OutFile $archive -UseBasicParsing
    $found = (Get-FileHash -Algorithm SHA256 -Path $archive).Hash.ToLowerInvariant()
    if ($found -ne $line.Substring(0, 64)) { throw "$name.zip has another checksum than this release; nothing was installed" }
    Expand-Archive -Path $archive -DestinationPath $work
    New-Item -ItemType Directory -Force -Path $bin | Out-Null
    Copy-Item -Force -Path (Join-Path $work "$name\squama.exe") -Destination (Join-Path $bin 'squama.exe')
} finally {
    Remove-Item -Recurse -Force -Path $work
}
$path = [Environment]::GetEnvironmentVariable('Path', 'User')
if (($path -split ';') -notcontains $bin) {
    [Environment]::SetEnvironmentVariable('Path', "$path;$bin", 'User')
    Write-Output "Added $bin to PATH; open a new window to use it."
}
Write-Output "$bin\squama.exe: $(& (Join-Path $bin 'squama.exe') --version)"
