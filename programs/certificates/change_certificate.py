"""The certificate of two programs that give the same: as that of equality, with the old program's sources.

What is claimed is about both sources and the binding between their names. To recheck is to read both again,
to make every question anew from them and from the relations, and to compare; nothing that is stored is
believed.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from modeproof.ground.errors import Unjudged
from programs.certificates.certificate_folder import NAME, VERSION, record_in, reference_files, tools
from programs.certificates.equality_certificate import TRUSTED as TRUSTED_OF_EQUALITY
from programs.certificates.equality_certificate import Kept, write
from programs.equality.product import Product
from programs.equality.replay import Replayed
from programs.equality.two_as_one import product_of
from programs.equality.two_programs import Names
from programs.equality.two_programs import Pair as Two
from programs.language.tree import Place, Source
from programs.properties.property_file import parsed
from programs.readers.sources import read_sources

FORMAT: Final = "modeproof-change-certificate"
TRUSTED: Final = tuple(one for one in TRUSTED_OF_EQUALITY if "explorer" not in one)
"""Besides the solver."""


def claim_of(pair: Two, product: Product, about: Mapping[str, Any]) -> dict[str, Any]:
    """What a proof is about. about: both units as they were chosen, and the hashes of both sources."""
    names = pair.names
    return {
        "format": FORMAT,
        "version": VERSION,
        "unit": pair.new.name,
        "old_unit": pair.old.name.removeprefix("OLD_"),
        "sources": about["sources"],
        "old_sources": about["old_sources"],
        "compared": list(product.binding.compared),
        "names": dict(names.names),
        "left_out": list(names.left_out),
        "constant": list(names.constant),
        "unless": names.unless_text,
        "wrap": product.wrap,
        "split": list(product.split),
        "control": list(product.control),
        "reference": _reference(pair),
        "trusted": list(TRUSTED),
        "tools": tools(),
    }


def _reference(pair: Two) -> dict[str, str]:
    """The files of the documents' blocks that one of them calls, with their SHA-256."""
    devices = [unit.device for unit in pair.source.units.values() if unit.device is not None]
    documents = sorted({device.reference.document for device in devices if hasattr(device, "reference")})
    return {path: known for document in documents for path, known in reference_files(document).items()}


def write_change(
    pair: Two,
    product: Product,
    replayed: Replayed,
    sources: tuple[Source, Source],
    folder: Path,
    binding: Path | None,
) -> int:
    """Write the certificate; the number of pairs to which no scans were found. Raises Unjudged.

    sources: of the new program, and of the old one.
    """
    about = {"sources": dict(sources[0].files), "old_sources": dict(sources[1].files)}
    ways = write(product, replayed, folder, binding, claim_of(pair, product, about))
    return len(product.nodes) - len(ways)


def read(folder: Path) -> tuple[Kept, Two, Product]:
    """The certificate in a folder, and both programs as they are now. Raises Unjudged."""
    kept = Kept(folder, record_in(folder, FORMAT))
    record = kept.record
    kept.files("binding_file")
    new, old = kept.files("sources"), kept.files("old_sources")
    try:
        text = str(record["unless"])
        unless = parsed(text, Place(str(folder / NAME), 1)) if text else None
        names = Names(
            dict(record["names"]), tuple(record["left_out"]), tuple(record["constant"]), unless, text
        )
        units = str(record["unit"]), str(record["old_unit"])
        wrap, split = bool(record["wrap"]), tuple(record["split"])
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise Unjudged(f"{folder / NAME}: not the form of a certificate: {error!r:.100}") from None
    first, second = read_sources(new), read_sources(old)
    pair = Two.of((first, first.chosen(units[0])), (second, second.chosen(units[1])), names)
    kept.same("reference", _reference(pair))
    return kept, pair, product_of(pair, wrap, split)
