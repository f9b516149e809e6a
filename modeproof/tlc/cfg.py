"""The former place of modeproof/registers/cfg.py."""

from modeproof.registers.cfg import COMMENT, Cfg, parse_cfg

__all__ = ["COMMENT", "Cfg", "parse_cfg"]
