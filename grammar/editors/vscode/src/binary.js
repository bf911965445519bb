// Finds the program `pinhole`, which contains the language server.

const fs = require("node:fs");
const os = require("node:os");
const path = require("node:path");

/**
 * Returns the path of the program `pinhole`. If the setting is empty, searches the folders on PATH,
 * the folder to which `cargo install` writes, and the extension's own folder, in this order.
 * Returns undefined if there is no such file.
 *
 * @param {string} setting `pinhole.path`: `~/` is the home folder, and a relative path starts at
 *   `folder`.
 * @param {string | undefined} folder The workspace's folder.
 * @param {string | undefined} extension The extension's folder.
 * @param {{ PATH?: string, CARGO_HOME?: string }} env
 */
function findBinary(setting, folder, extension, env = process.env) {
  const home = os.homedir();
  const wanted = setting.trim();
  if (wanted !== "") {
    const whole = wanted.startsWith("~/") ? path.join(home, wanted.slice(2)) : wanted;
    return existing(path.resolve(folder ?? home, whole));
  }
  const cargo = path.join(env.CARGO_HOME || path.join(home, ".cargo"), "bin");
  const folders = (env.PATH ?? "").split(path.delimiter).filter(folder => path.isAbsolute(folder));
  const own = extension === undefined ? [] : [path.join(extension, "bin")];
  return [...folders, cargo, ...own].map(folder => existing(path.join(folder, "pinhole"))).find(Boolean);
}

/**
 * Returns the path of an executable file; undefined if there is none. On Windows, `.exe` is added
 * if the name does not end in it.
 */
function existing(file) {
  const names = process.platform === "win32" && !file.toLowerCase().endsWith(".exe") ? [`${file}.exe`] : [file];
  return names.find(name => {
    try {
      fs.accessSync(name, fs.constants.X_OK);
      return fs.statSync(name).isFile();
    } catch {
      return false;
    }
  });
}

module.exports = { findBinary };
