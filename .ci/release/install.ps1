# Installs mbint for Windows:
#
#   powershell -ExecutionPolicy ByPass -c "irm https://github.com/mbint/mbint/releases/latest/download/install.ps1 | iex"
#
# $env:MBINT_INSTALL_DIR is the folder of the program, $env:MBINT_VERSION the version [the latest].
$ErrorActionPreference = 'Stop'

$folder = if ($env:MBINT_INSTALL_DIR) { $env:MBINT_INSTALL_DIR } else { Join-Path $env:LOCALAPPDATA 'Programs\mbint' }
$release = if ($env:MBINT_VERSION) { "download/v$($env:MBINT_VERSION)" } else { 'latest/download' }
$from = "https://github.com/mbint/mbint/releases/$release"
$processor = if ($env:PROCESSOR_ARCHITECTURE -eq 'ARM64') { 'aarch64' } else { 'x86_64' }
$name = "mbint-$processor-pc-windows-msvc"

$place = Join-Path ([IO.Path]::GetTempPath()) ([IO.Path]::GetRandomFileName())
New-Item -ItemType Directory $place | Out-Null
try {
    foreach ($file in "$name.zip", "$name.zip.sha256") {
        Invoke-WebRequest -UseBasicParsing "$from/$file" -OutFile (Join-Path $place $file)
    }
    $expected = ((Get-Content (Join-Path $place "$name.zip.sha256")) -split '\s+')[0]
    $found = (Get-FileHash -Algorithm SHA256 (Join-Path $place "$name.zip")).Hash
    if ($found -ne $expected) { throw 'the checksum is not that of the archive' }
    Expand-Archive (Join-Path $place "$name.zip") $place
    New-Item -ItemType Directory -Force $folder | Out-Null
    Move-Item -Force (Join-Path $place "$name\mbint.exe") (Join-Path $folder 'mbint.exe')
} finally {
    Remove-Item -Recurse -Force $place
}
& (Join-Path $folder 'mbint.exe') --version
$path = [Environment]::GetEnvironmentVariable('Path', 'User')
if (($path -split ';') -notcontains $folder) {
    [Environment]::SetEnvironmentVariable('Path', "$path;$folder", 'User')
    Write-Output "$folder was added to Path; open another terminal"
}
